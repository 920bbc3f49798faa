// SPDX-License-Identifier: BSD-3-Clause
#include "systems/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "framework/error.h"

namespace oca::systems {
namespace {

std::string_view Trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\r') || byte == 0x7f;
}

/// The beginning of a cell, printable.
std::string Shown(std::string_view cell) {
  std::string shown(cell.substr(0, 40));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

std::string ReadText(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (error || !std::filesystem::exists(status)) {
    throw ConfigError(fmt::format("{}: cannot be read; expected a CSV file", file));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw ConfigError(fmt::format(
        "{}: not a regular file; got a folder, pipe or device; expected a CSV file", file));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > CsvTable::kLargestFile) {
    throw ConfigError(fmt::format("{}: too large; got {} bytes; expected at most {}", file, bytes,
                                  CsvTable::kLargestFile));
  }
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    throw ConfigError(fmt::format("{}: cannot be read; expected a CSV file", file));
  }
  // No more than was promised, should the file grow meanwhile.
  std::string text(bytes, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

CsvTable::CsvTable(const std::string& file) : file_(file), text_(ReadText(file)) {}

std::string CsvTable::where() const { return fmt::format("{}:{}", file_, line_); }

bool CsvTable::NextRow() {
  while (next_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', next_), text_.size());
    std::string_view line = std::string_view(text_).substr(next_, end - next_);
    next_ = end + 1;
    ++line_;
    const auto control = std::find_if(line.begin(), line.end(), IsControl);
    if (control != line.end()) {
      throw ConfigError(fmt::format("{}: control character; got byte {:#04x}; expected text",
                                    where(), static_cast<unsigned char>(*control)));
    }
    line = Trimmed(line);
    if (line.empty() || line.starts_with('#')) continue;
    cells_.clear();
    for (auto comma = line.find(','); comma != line.npos; comma = line.find(',')) {
      cells_.push_back(Trimmed(line.substr(0, comma)));
      line.remove_prefix(comma + 1);
    }
    cells_.push_back(Trimmed(line));
    return true;
  }
  return false;
}

double CsvTable::Number(std::size_t column) const {
  const std::string_view cell = cells_.at(column);
  std::string_view digits = cell;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc() && end == digits.data() + digits.size() && std::isfinite(number)) {
    return number;
  }
  throw ConfigError(
      fmt::format("{}: not a number; got '{}'; expected a finite number", where(), Shown(cell)));
}

}  // namespace oca::systems
