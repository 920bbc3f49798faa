// SPDX-License-Identifier: BSD-3-Clause
#include "models/geometry/table_text.h"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <iterator>

#include "models/error.h"

namespace oca::models::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 100'000'000;
constexpr std::string_view kGaps = ",; \t\r";

}  // namespace

void RefuseText(const fs::path& file, int line, std::string_view what, std::string_view got,
                std::string_view expected) {
  const std::string place = line > 0 ? fmt::format("{}:{}", file.string(), line) : file.string();
  throw ModelError(
      fmt::format("{}: {}; got {}; expected {}", place, what, got.substr(0, 60), expected));
}

std::string ReadWhole(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    RefuseText(file, 0, "cannot be read", "no plain file", "a file");
  }
  const auto size = fs::file_size(file, error);
  if (error || size > kMaxBytes) {
    RefuseText(file, 0, "is too large", fmt::format("{} bytes", size), "at most 100 MB");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) RefuseText(file, 0, "cannot be read", "an error", "a file");
  return text;
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
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::string_view TakeLine(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace oca::models::internal
