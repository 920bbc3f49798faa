// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_sink.h"

#include <map>

namespace oca::record {

void McapSink::Begin(const std::vector<RecordChannel>& channels) {
  std::map<std::string, std::uint16_t> schemas;
  for (const RecordChannel& channel : channels) {
    auto& schema = schemas[channel.schema_name];
    if (schema == 0) {
      schema = writer_.AddSchema(channel.schema_name, "jsonschema", channel.schema);
    }
    writer_.AddChannel(channel.topic, "json", schema);
  }
  writer_.Flush();
}

void McapSink::Write(int channel, std::uint64_t time, std::string_view json) {
  writer_.Write(static_cast<std::uint16_t>(channel + 1), time, json);
}

void McapSink::Idle() {
  const auto now = std::chrono::steady_clock::now();
  if (now - flushed_ < std::chrono::seconds(1)) return;
  flushed_ = now;
  writer_.Flush();
}

}  // namespace oca::record
