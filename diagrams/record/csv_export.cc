// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/record/csv_export.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "diagrams/record/series.h"
#include "framework/error.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Columns and cells of a vector's message; false if it is another signal's.
bool Cells(const ordered_json& json, std::vector<std::string>& names,
           std::vector<std::string>& cells) {
  names.clear();
  cells.clear();
  const bool listed = json.is_object() && json.size() == 1 && json.contains("values");
  const ordered_json& numbers = listed ? json["values"] : json;
  if (!numbers.is_structured() || (!listed && !numbers.is_object())) return false;
  for (const auto& [key, value] : numbers.items()) {
    if (!value.is_number() && !value.is_null()) return false;
    names.push_back(listed ? fmt::format("[{}]", key) : key);
    cells.push_back(value.is_null() ? "nan" : value.dump());
  }
  return true;
}

std::string LineOf(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += "," + cell;
  return line + "\n";
}

}  // namespace

int ExportCsv(const McapFile& record, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw ConfigError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  const std::uint64_t start = StartOf(record);
  int files = 0;
  for (const McapChannel& channel : record.channels()) {
    if (!IsSignal(channel)) continue;
    const auto messages = record.MessagesOf(channel.topic);
    if (messages.empty()) continue;
    std::vector<std::string> header, names, cells;
    const bool vector = Cells(ordered_json::parse(messages.front()->data), header, cells);
    const fs::path file = folder / (SignalName(channel) + (vector ? ".csv" : ".jsonl"));
    std::ofstream stream(file, std::ios::trunc);
    if (vector) stream << "time" << LineOf(header);
    for (const McapMessage* const message : messages) {
      const double time = static_cast<double>(message->log_time - start) * 1e-9;
      if (vector) {
        Cells(ordered_json::parse(message->data), names, cells);
        stream << fmt::format("{}", time) << LineOf(cells);
      } else {
        stream << fmt::format("{{\"time\":{},\"value\":{}}}\n", time, message->data);
      }
    }
    if (!stream.flush()) throw ConfigError(fmt::format("{}: cannot be written", file.string()));
    ++files;
  }
  return files;
}

}  // namespace oca::record
