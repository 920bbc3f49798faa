// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/comparison.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "oca/diagrams/record/message_json.h"
#include "oca/diagrams/record/series.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::record {
namespace {

using nlohmann::ordered_json;

/// The first message in which one topic differs.
std::optional<Difference> DifferenceOf(const McapFile& first, const McapFile& second,
                                       const McapChannel& channel, int& compared) {
  const auto ours = first.MessagesOf(channel.topic);
  const auto theirs = second.MessagesOf(channel.topic);
  const std::uint64_t start = StartOf(first), other_start = StartOf(second);
  for (std::size_t i = 0; i < std::max(ours.size(), theirs.size()); ++i) {
    const McapMessage* const a = i < ours.size() ? ours[i] : nullptr;
    const McapMessage* const b = i < theirs.size() ? theirs[i] : nullptr;
    const std::uint64_t time_a = a == nullptr ? UINT64_MAX : a->log_time - start;
    const std::uint64_t time_b = b == nullptr ? UINT64_MAX : b->log_time - other_start;
    if (a != nullptr && b != nullptr && time_a == time_b && a->data == b->data) {
      ++compared;
      continue;
    }
    const std::uint64_t time = std::min(time_a, time_b);
    return Difference{static_cast<double>(time) / 1e9, SignalName(channel),
                      time_a == time ? std::string(a->data) : "",
                      time_b == time ? std::string(b->data) : ""};
  }
  return std::nullopt;
}

std::map<std::string, std::string> MetricsOf(const McapFile& record,
                                             std::vector<std::string>& order) {
  std::map<std::string, std::string> metrics;
  const auto messages = record.MessagesOf("/metrics");
  if (messages.empty()) return metrics;
  const auto json = internal::MessageJson(record, *messages.back(), "/metrics");
  if (!json.is_object()) return metrics;
  for (const auto& [key, value] : json.items()) {
    metrics[key] = value.is_null() ? "" : oca::internal::JsonText(value);
    if (std::find(order.begin(), order.end(), key) == order.end()) order.push_back(key);
  }
  return metrics;
}

}  // namespace

Comparison Compare(const McapFile& first, const McapFile& second) {
  Comparison comparison;
  std::vector<const McapChannel*> channels;
  for (const McapFile* const record : {&first, &second}) {
    for (const McapChannel& channel : record->channels()) {
      const bool known = std::any_of(channels.begin(), channels.end(), [&](const auto* other) {
        return other->topic == channel.topic;
      });
      if (IsSignal(channel) && !known) channels.push_back(&channel);
    }
  }
  for (const McapChannel* const channel : channels) {
    auto difference = DifferenceOf(first, second, *channel, comparison.messages);
    const bool sooner =
        difference && (!comparison.difference || difference->time < comparison.difference->time);
    if (sooner) comparison.difference = std::move(difference);
  }
  std::vector<std::string> order;
  auto ours = MetricsOf(first, order);
  auto theirs = MetricsOf(second, order);
  for (const std::string& name : order) {
    comparison.metrics.push_back({name, ours[name], theirs[name]});
  }
  return comparison;
}

}  // namespace oca::record
