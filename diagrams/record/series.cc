// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/series.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "oca/diagrams/record/message_json.h"
#include "oca/models/foreign_text.h"

namespace oca::record {
namespace {

using nlohmann::ordered_json;

/// Empty if there is none.
std::string TextIn(const ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() || !found->is_string() ? "" : found->get<std::string>();
}

/// The numbers of one message with the ends of their names.
void Flatten(const ordered_json& json, const std::string& name,
             std::vector<std::pair<std::string, double>>& out) {
  if (json.is_number()) {
    out.emplace_back(name, json.get<double>());
  } else if (json.is_array() && !json.empty() && json[0].is_object() &&
             json[0].contains("distance")) {
    for (const auto& pair : json) {
      const auto distance = pair.find("distance");
      if (distance == pair.end() || !distance->is_number()) continue;
      out.emplace_back("." + TextIn(pair, "link") + "/" + TextIn(pair, "obstacle"),
                       distance->get<double>());
    }
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      if (json[i].is_number()) Flatten(json[i], fmt::format("[{}]", i), out);
    }
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items()) Flatten(value, "." + key, out);
  }
}

std::string UnitOf(const McapFile& record, const McapChannel& channel) {
  const McapSchema* const schema = record.FindSchema(channel.schema);
  if (schema == nullptr) return "";
  const std::size_t at = schema->data.find("\"x-unit\":\"");
  if (at == std::string::npos) return "";
  const std::size_t start = at + 10;
  return schema->data.substr(start, schema->data.find('"', start) - start);
}

}  // namespace

bool IsSignal(const McapChannel& channel) {
  const std::string& topic = channel.topic;
  return topic.size() > 2 && topic.find('/', 1) != std::string::npos &&
         !topic.starts_with("/scene/");
}

std::string SignalName(const McapChannel& channel) {
  std::string name = channel.topic.substr(1);
  std::replace(name.begin(), name.end(), '/', '.');
  return models::internal::Harmless(name);  // it is shown, and files are named by it
}

std::uint64_t StartOf(const McapFile& record) {
  const Texts* const main = record.FindMetadata("oca");
  if (main != nullptr && main->contains("start_epoch_ns")) {
    return std::strtoull(main->at("start_epoch_ns").c_str(), nullptr, 10);
  }
  return record.messages().empty() ? 0 : record.messages().front().log_time;
}

std::vector<Series> ReadSeries(const McapFile& record, const std::string& pattern) {
  const std::uint64_t start = StartOf(record);
  std::vector<Series> found;
  std::vector<std::pair<std::string, double>> numbers;
  for (const McapChannel& channel : record.channels()) {
    if (!IsSignal(channel)) continue;
    const std::string signal = SignalName(channel);
    const bool whole = fnmatch(pattern.c_str(), signal.c_str(), 0) == 0;
    std::map<std::string, std::size_t> places;
    for (const McapMessage* const message : record.MessagesOf(channel.topic)) {
      numbers.clear();
      Flatten(internal::MessageJson(record, *message, channel.topic), "", numbers);
      const double time = static_cast<double>(message->log_time - start) / 1e9;
      for (const auto& [end, value] : numbers) {
        const std::string name = signal + end;
        if (!whole && fnmatch(pattern.c_str(), name.c_str(), 0) != 0) continue;
        const auto [place, fresh] = places.emplace(name, found.size());
        if (fresh) found.push_back({name, UnitOf(record, channel), {}, {}, signal});
        found[place->second].times.push_back(time);
        found[place->second].values.push_back(value);
      }
    }
  }
  return found;
}

}  // namespace oca::record
