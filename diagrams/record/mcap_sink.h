// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "oca/diagrams/record/mcap_writer.h"
#include "oca/diagrams/record/record_sink.h"

namespace oca::record {

/// Writes an MCAP stream of JSON messages; what was written is flushed every second. A channel
/// whose topic it knows goes on.
class McapSink final : public RecordSink {
 public:
  /// The stream must outlive the sink.
  McapSink(std::ostream& stream, Compression compression) : writer_(stream, compression) {}

  void Begin(const std::vector<RecordChannel>& channels) override;
  void Write(int channel, const RecordSample& sample) override;
  void AddMetadata(const Metadata& metadata) override { writer_.AddMetadata(metadata); }
  void AddAttachment(const Attachment& attachment) override { writer_.AddAttachment(attachment); }
  void Idle() override;
  void End() override { writer_.Close(); }

 private:
  McapWriter writer_;
  std::map<std::string, std::uint16_t> schemas_;  ///< numbers in the file, by name
  std::map<std::string, std::uint16_t> topics_;   ///< channels of the file
  std::vector<std::uint16_t> channels_;           ///< of the file, by those of the diagram
  std::chrono::steady_clock::time_point flushed_{std::chrono::steady_clock::now()};
};

}  // namespace oca::record
