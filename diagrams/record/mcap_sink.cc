// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/mcap_sink.h"

namespace oca::record {

void McapSink::Begin(const std::vector<RecordChannel>& channels) {
  channels_.clear();
  for (const RecordChannel& channel : channels) {
    auto& number = topics_[channel.topic];
    if (number == 0) {
      auto& schema = schemas_[channel.schema_name];
      if (schema == 0) {
        schema = writer_.AddSchema(channel.schema_name, "jsonschema", channel.schema);
      }
      number = writer_.AddChannel(channel.topic, "json", schema);
    }
    channels_.push_back(number);
  }
  writer_.Flush();
}

void McapSink::Write(int channel, const RecordSample& sample) {
  writer_.Write(channels_[static_cast<std::size_t>(channel)], sample.time(), sample.json());
}

void McapSink::Idle() {
  const auto now = std::chrono::steady_clock::now();
  if (now - flushed_ < std::chrono::seconds(1)) return;
  flushed_ = now;
  writer_.Flush();
}

}  // namespace oca::record
