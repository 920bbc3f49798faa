// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "oca/diagrams/record/mcap_writer.h"

namespace oca::record {

/// A stream of JSON messages. `schema` is a JSON Schema.
struct RecordChannel {
  std::string topic{};
  std::string schema_name{};
  std::string schema{};
};

/// Where the messages of a run go: a file, or whoever looks on. Unless told otherwise, called on
/// the recorder's own thread, one call at a time; may take its time there.
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  /// Before the run, on its thread: channel number `i` is channels[i].
  virtual void Begin(const std::vector<RecordChannel>& channels) = 0;
  /// `time` ns since the epoch.
  virtual void Write(int channel, std::uint64_t time, std::string_view json) = 0;
  virtual void AddMetadata(const McapMetadata& /*metadata*/) {}
  virtual void AddAttachment(const McapAttachment& /*attachment*/) {}
  /// Many times a second, also while nothing is written.
  virtual void Idle() {}
  /// After the last message, on the thread of the run.
  virtual void End() {}
};

/// Writes an MCAP stream; what was written is flushed every second.
class McapSink final : public RecordSink {
 public:
  /// The stream must outlive the sink.
  McapSink(std::ostream& stream, Compression compression) : writer_(stream, compression) {}

  void Begin(const std::vector<RecordChannel>& channels) override;
  void Write(int channel, std::uint64_t time, std::string_view json) override;
  void AddMetadata(const McapMetadata& metadata) override { writer_.AddMetadata(metadata); }
  void AddAttachment(const McapAttachment& attachment) override {
    writer_.AddAttachment(attachment);
  }
  void Idle() override;
  void End() override { writer_.Close(); }

 private:
  McapWriter writer_;
  std::chrono::steady_clock::time_point flushed_{std::chrono::steady_clock::now()};
};

}  // namespace oca::record
