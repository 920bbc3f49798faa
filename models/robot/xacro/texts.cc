// SPDX-License-Identifier: BSD-3-Clause
// Texts as Python reads and formats them, of functions.h.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "oca/models/robot/xacro/functions.h"

namespace oca::robot::xacro {
namespace {

std::string_view WithoutBlanks(std::string_view text) {
  constexpr std::string_view kAround = " \t\r\n\f\v";
  const std::size_t from = std::min(text.find_first_not_of(kAround), text.size());
  return text.substr(from, text.find_last_not_of(kAround) + 1 - from);
}

/// Takes a + off, which from_chars does not know; false if another sign follows.
bool TakePlus(std::string_view& text) {
  if (!text.starts_with('+')) return true;
  text.remove_prefix(1);
  return !text.starts_with('-') && !text.starts_with('+');
}

/// One value by a conversion such as `%05.2f`.
std::string Converted(std::string conversion, const PythonValue& value) {
  const char kind = conversion.back();
  if (kind == 's' || kind == 'r') {
    if (conversion.size() > 2) throw Mistake("'%'", conversion, "%s");
    return kind == 's' ? ToText(value) : Repr(value);
  }
  if (!value.is_number()) throw Mistake("'%'", Shown(value), "a number for " + conversion);
  char buffer[512];
  int length = 0;
  if (kind == 'd' || kind == 'i' || kind == 'x' || kind == 'X') {
    conversion.insert(conversion.size() - 1, "ll");
    const auto whole = static_cast<long long>(
        value.is_float() ? ToWhole(std::trunc(value.number()), "'%'") : value.whole());
    length = std::snprintf(buffer, sizeof buffer, conversion.c_str(), whole);
  } else {
    length = std::snprintf(buffer, sizeof buffer, conversion.c_str(), value.number());
  }
  if (length < 0 || length >= static_cast<int>(sizeof buffer)) {
    throw Mistake("'%'", conversion, "at most 500 characters");
  }
  return buffer;
}

}  // namespace

PythonValue FormatPercent(const std::string& format, const PythonValue& value) {
  const bool tuple = value.list() != nullptr && value.list()->tuple;
  const PythonValue::Items values = tuple ? value.list()->items : PythonValue::Items{value};
  std::string text;
  std::size_t used = 0, from = 0;
  for (std::size_t at = format.find('%'); at != std::string::npos; at = format.find('%', from)) {
    text.append(format, from, at - from);
    const std::size_t end = format.find_first_not_of("0123456789.+- #", at + 1);
    if (end == std::string::npos ||
        std::string_view("sdifFgGeExXr%").find(format[end]) == std::string_view::npos ||
        end - at > 8) {
      throw Mistake("'%'", format.substr(at, 8), "%s, %d, %i, %x, %f, %g or %e");
    }
    from = end + 1;
    if (format[end] == '%') {
      text += '%';
      continue;
    }
    if (used >= values.size()) throw Mistake("'%'", "too few values", "one a conversion");
    text += Converted(format.substr(at, from - at), values[used++]);
    if (text.size() > kMostText) throw Mistake("'%'", "a text above 1 MB", "a shorter one");
  }
  if (used < values.size()) throw Mistake("'%'", "too many values", "one a conversion");
  return PythonValue(text.append(format, from, std::string::npos));
}

const std::string& TextArgument(std::string_view what, const Arguments& arguments, std::size_t i) {
  if (arguments.values[i].text() == nullptr) {
    throw Mistake(what, Shown(arguments.values[i]), "a text");
  }
  return *arguments.values[i].text();
}

std::vector<std::size_t> CharacterOffsets(const std::string& text) {
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) offsets.push_back(i);
  }
  offsets.push_back(text.size());
  return offsets;
}

std::optional<std::int64_t> WholeOf(std::string_view text) {
  text = WithoutBlanks(text);
  if (!TakePlus(text)) return std::nullopt;
  std::int64_t whole = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return whole;
}

std::optional<double> NumberOf(std::string_view text) {
  text = WithoutBlanks(text);
  if (!TakePlus(text) || text.find('(') != text.npos) return std::nullopt;  // nan(...) is C's alone
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
  // Beyond a double's range it is infinite or 0.
  return error == std::errc() ? number : std::strtod(std::string(text).c_str(), nullptr);
}

}  // namespace oca::robot::xacro
