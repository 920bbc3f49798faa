// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/signal_table.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "oca/framework/dataflow/error.h"
#include "oca/models/csv_names.h"

namespace oca::runs {
namespace {

namespace fs = std::filesystem;

double Seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e9; }

}  // namespace

std::int64_t Nanoseconds(double t) { return static_cast<std::int64_t>(std::llround(t * 1e9)); }

void MakeObject(std::string& json, std::size_t start, const std::string& port) {
  if (json.size() <= start || json[start] == '{') return;
  json.insert(start, "{\"" + port + "\":");
  json += '}';
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw ConfigError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
}

std::vector<std::string> SignalTable::Columns(const std::string& port, int size,
                                              const std::vector<std::string>& joints) {
  if (!joints.empty()) return joints;
  std::vector<std::string> columns;
  for (int i = 0; i < size; ++i) columns.push_back(fmt::format("{}[{}]", port, i));
  return columns;
}

fs::path SignalTable::FileOf(const fs::path& folder, const std::string& signal, bool in_columns) {
  return folder / (signal + (in_columns ? ".csv" : ".jsonl"));
}

SignalTable::SignalTable(const fs::path& folder, const std::string& signal,
                         const std::optional<std::vector<std::string>>& columns)
    : file_(FileOf(folder, signal, columns.has_value())) {
  if (!columns) return;
  line_ = "time";
  for (const std::string& column : models::UniqueColumns(*columns)) {
    line_ += ',';
    models::AppendCsvName(line_, column);
  }
  file_.stream() << line_ << '\n';
}

void SignalTable::Write(std::int64_t nanoseconds, std::span<const double> numbers) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}", Seconds(nanoseconds));
  for (const double number : numbers) {
    fmt::format_to(std::back_inserter(line_), ",{}", number);
  }
  line_ += '\n';
  file_.stream().write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

void SignalTable::Write(std::int64_t nanoseconds, std::string_view json) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{{\"time\":{},\"value\":{}}}\n", Seconds(nanoseconds),
                 json);
  file_.stream().write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

void SignalTable::Finish() { file_.Commit(); }

}  // namespace oca::runs
