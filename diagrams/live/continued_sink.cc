// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/continued_sink.h"

#include <algorithm>

namespace oca::live {

void ContinuedSink::Begin(const std::vector<record::RecordChannel>& channels) {
  if (topics_.empty()) {
    for (const record::RecordChannel& channel : channels) topics_.push_back(channel.topic);
    sink_.Begin(channels);
  }
  places_.clear();
  for (const record::RecordChannel& channel : channels) {
    const auto found = std::find(topics_.begin(), topics_.end(), channel.topic);
    places_.push_back(found == topics_.end() ? -1 : static_cast<int>(found - topics_.begin()));
  }
}

void ContinuedSink::Write(int channel, std::uint64_t time, std::string_view json) {
  const int place = places_[static_cast<std::size_t>(channel)];
  if (place >= 0) sink_.Write(place, time, json);
}

}  // namespace oca::live
