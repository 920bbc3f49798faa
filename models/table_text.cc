// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/table_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "oca/models/error.h"

namespace oca::models::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kGaps = " \t\r";
constexpr std::string_view kBlanks = " \t";
constexpr std::size_t kLongestTableLine = 10'000'000;

}  // namespace

void RefuseText(const fs::path& file, int line, std::string_view what, std::string_view got,
                std::string_view expected) {
  const std::string place = line > 0 ? fmt::format("{}:{}", file.string(), line) : file.string();
  throw ModelError(
      fmt::format("{}: {}; got {}; expected {}", place, what, got.substr(0, 60), expected));
}

std::vector<std::string_view> Words(std::string_view text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t first = text.find_first_not_of(kGaps);
    if (first == std::string_view::npos) return words;
    text.remove_prefix(first);
    const std::size_t end = std::min(text.find_first_of(kGaps), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

std::optional<double> ToNumber(std::string_view word) {
  double value = 0.0;
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> ToCount(std::string_view word, std::uint64_t most) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value > most) return std::nullopt;
  return value;
}

std::string_view TakeLine(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view TakeTableLine(const fs::path& file, int line, std::string_view& rest) {
  const std::string_view taken = TakeLine(rest);
  if (taken.size() <= kLongestTableLine) return taken;
  RefuseText(file, line, "a line too long", fmt::format("{} characters", taken.size()),
             fmt::format("at most {}", kLongestTableLine));
}

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

std::string_view Trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::string Shown(std::string_view cell) {
  std::string shown(cell.substr(0, 40));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

bool LooksLikeNumber(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  return ToNumber(cell).has_value();
}

}  // namespace oca::models::internal
