// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/record_sink.h"

namespace oca::live {

/// One record of several recorders that follow each other, as each change of a parameter makes a
/// new one: what the first declares holds for all, and End is the owner's.
class ContinuedSink final : public record::RecordSink {
 public:
  /// The sink must outlive this one.
  explicit ContinuedSink(record::RecordSink& sink) : sink_(sink) {}

  void Begin(const std::vector<record::RecordChannel>& channels) override;
  /// What the first recorder had no channel for is left out.
  void Write(int channel, std::uint64_t time, std::string_view json) override;
  void AddMetadata(const record::McapMetadata& metadata) override { sink_.AddMetadata(metadata); }
  void AddAttachment(const record::McapAttachment& attachment) override {
    sink_.AddAttachment(attachment);
  }
  void Idle() override { sink_.Idle(); }

 private:
  record::RecordSink& sink_;
  std::vector<std::string> topics_;  ///< of the first recorder
  std::vector<int> places_;          ///< in topics_ of the present one's channels; -1: none
};

}  // namespace oca::live
