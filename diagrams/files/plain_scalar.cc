// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/plain_scalar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace oca::files {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// YAML 1.2 core schema: [-+]? (digits [. digits*]? | . digits) ([eE] [-+]? digits)?
bool LooksLikeNumber(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t from = i;
    while (i < text.size() && IsDigit(text[i])) ++i;
    return i - from;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  std::size_t count = digits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    count += digits();
  }
  if (count == 0) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) return false;
  }
  return i == text.size();
}

Value::Data ReadNumber(const std::string& text, std::string& problem) {
  const char* first = text.data() + (text[0] == '+' ? 1 : 0);
  const char* const last = text.data() + text.size();
  const char* const digits = first + (*first == '-' ? 1 : 0);
  if (last - digits > 1 && digits[0] == '0' && IsDigit(digits[1])) {
    problem =
        fmt::format("got {}; expected a number without leading zeros, or text in quotes", text);
    return {};
  }
  std::int64_t whole = 0;
  if (const auto [end, error] = std::from_chars(first, last, whole);
      error == std::errc() && end == last) {
    return whole;
  }
  double real = 0.0;
  const auto [end, error] = std::from_chars(first, last, real);
  if (error != std::errc() || end != last || !std::isfinite(real)) {
    problem = fmt::format("got {}; expected a number that a double can hold", text);
    return {};
  }
  return real;
}

}  // namespace

Value::Data ReadPlainScalar(const std::string& text, std::string& problem) {
  if (text == "true") return true;
  if (text == "false") return false;
  if (text == "null" || text == "~" || text == "Null" || text == "NULL") {
    problem = "got null; expected a value";
    return {};
  }
  static constexpr std::array kAmbiguous = {"yes", "no",  "on",   "off",  "Yes",   "No",   "On",
                                            "Off", "YES", "NO",   "ON",   "OFF",   "y",    "n",
                                            "Y",   "N",   "True", "TRUE", "False", "FALSE"};
  if (std::find(kAmbiguous.begin(), kAmbiguous.end(), text) != kAmbiguous.end()) {
    problem = fmt::format("got {0}; expected true or false, or '{0}' in quotes for the text", text);
    return {};
  }
  return LooksLikeNumber(text) ? ReadNumber(text, problem) : Value::Data(text);
}

}  // namespace oca::files
