// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/csv_export.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "oca/diagrams/record/message_json.h"
#include "oca/diagrams/record/series.h"
#include "oca/diagrams/runs/signal_table.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using runs::SignalTable;

/// Names and numbers of a vector's message, without names but numbered ones; false if it is another
/// signal's.
bool Numbers(const ordered_json& json, std::vector<std::string>& joints,
             std::vector<double>& numbers) {
  joints.clear();
  numbers.clear();
  const bool listed =
      json.is_object() && json.size() == 1 && json.contains("values") && json["values"].is_array();
  const ordered_json& values = listed ? json["values"] : json;
  if (!listed && !values.is_object()) return false;
  for (const auto& [key, value] : values.items()) {
    if (!value.is_number() && !value.is_null()) return false;
    if (!listed) joints.push_back(key);
    numbers.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                      : value.get<double>());
  }
  return true;
}

bool IsVector(const ordered_json& json) {
  std::vector<std::string> joints;
  std::vector<double> numbers;
  return Numbers(json, joints, numbers);
}

}  // namespace

std::vector<fs::path> ExportedFiles(const McapFile& record, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const McapChannel& channel : record.channels()) {
    if (!IsSignal(channel)) continue;
    const auto messages = record.MessagesOf(channel.topic);
    if (messages.empty()) continue;
    const bool vector = IsVector(internal::MessageJson(record, *messages.front(), channel.topic));
    files.push_back(SignalTable::FileOf(folder, SignalName(channel), vector));
  }
  return files;
}

int ExportCsv(const McapFile& record, const fs::path& folder) {
  runs::MakeFolder(folder);
  const std::uint64_t start = StartOf(record);
  int files = 0;
  for (const McapChannel& channel : record.channels()) {
    if (!IsSignal(channel)) continue;
    const auto messages = record.MessagesOf(channel.topic);
    if (messages.empty()) continue;
    const std::string signal = SignalName(channel);
    std::vector<std::string> joints;
    std::vector<double> numbers;
    std::optional<std::vector<std::string>> columns;
    if (Numbers(internal::MessageJson(record, *messages.front(), channel.topic), joints, numbers)) {
      columns = SignalTable::Columns(signal.substr(signal.rfind('.') + 1),
                                     static_cast<int>(numbers.size()), joints);
    }
    SignalTable table(folder, signal, columns);
    for (const McapMessage* const message : messages) {
      const auto time = static_cast<std::int64_t>(message->log_time - start);
      if (columns) {
        Numbers(internal::MessageJson(record, *message, channel.topic), joints, numbers);
        table.Write(time, numbers);
      } else {
        table.Write(time, message->data);
      }
    }
    table.Finish();
    ++files;
  }
  return files;
}

}  // namespace oca::record
