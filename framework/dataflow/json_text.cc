// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "oca/framework/dataflow/error.h"

namespace oca::internal {
namespace {

using Json = nlohmann::ordered_json;

/// The beginning of a text from a place on, printable.
std::string ShownFrom(std::string_view text, std::size_t at) {
  if (at >= text.size()) return "its end";
  std::string shown(text.substr(at, 20));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + shown + "'";
}

/// Outside of texts, which may hold any bracket.
void CheckLevels(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == '{')) {
      ++depth;
    } else if (!quoted && (c == ']' || c == '}')) {
      --depth;
    }
    if (depth > kDeepestJson) {
      throw ConfigError(
          fmt::format("JSON: byte {}: nested too deep; got more than {} levels; "
                      "expected fewer",
                      i + 1, kDeepestJson));
    }
  }
}

/// Of a text, for nlohmann's parser, which does not tell how far it has read.
class Cursor {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Cursor(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  const char& operator*() const { return *at_; }
  Cursor& operator++() {
    *furthest_ = ++at_;
    return *this;
  }
  friend bool operator==(const Cursor& a, const Cursor& b) { return a.at_ == b.at_; }
  friend bool operator!=(const Cursor& a, const Cursor& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  const char** furthest_;
};

class StrictParser {
 public:
  explicit StrictParser(std::string_view text) : text_(text), furthest_(text.data()) {}

  Json Parse() {
    try {
      return Json::parse(
          Cursor(text_.data(), &furthest_), Cursor(text_.data() + text_.size(), &furthest_),
          [this](int, Json::parse_event_t event, Json& parsed) { return Check(event, parsed); });
    } catch (const Json::parse_error& error) {
      const std::size_t at = error.byte == 0 ? 0 : error.byte - 1;
      Fail(at, "syntax", ShownFrom(text_, at), "valid JSON");
    } catch (const Json::out_of_range&) {
      constexpr std::string_view kDigits = "+-.0123456789eE";
      // The parser has looked at the character behind the number, if there is one.
      const std::size_t last = text_.find_last_of(kDigits, Read() - 1);
      const std::size_t first = text_.find_last_not_of(kDigits, last) + 1;
      Fail(first, "number", text_.substr(first, std::min<std::size_t>(last - first + 1, 40)),
           "finite numbers, up to 1.8e308");
    }
  }

 private:
  std::size_t Read() const { return static_cast<std::size_t>(furthest_ - text_.data()); }

  [[noreturn]] static void Fail(std::size_t at, std::string_view what, std::string_view got,
                                std::string_view expected) {
    throw ConfigError(
        fmt::format("JSON: byte {}: {}; got {}; expected {}", at + 1, what, got, expected));
  }

  /// nlohmann keeps one of two equal keys without a word.
  bool Check(Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event != Json::parse_event_t::key) return true;
    const auto key = parsed.get<std::string>();
    if (open_.back().insert(key).second) return true;
    Fail(BeginOfText(), "duplicate key", fmt::format("'{:.100}'", key), "each key once");
  }

  /// The opening quote of the text that has been read last.
  std::size_t BeginOfText() const {
    std::size_t at = Read() - 1;  // its closing quote
    while (at > 0) {
      at = text_.rfind('"', at - 1);
      const std::size_t before = text_.find_last_not_of('\\', at - 1);
      if (at == 0 || (at - 1 - before) % 2 == 0) break;
    }
    return at;
  }

  std::string_view text_;
  const char* furthest_;
  std::vector<std::set<std::string>> open_;
};

}  // namespace

Json ReadJsonTree(std::string_view text) {
  CheckLevels(text);
  return StrictParser(text).Parse();
}

std::int64_t WholeNumber(const nlohmann::ordered_json& json, std::int64_t least,
                         std::int64_t most) {
  const bool beyond = json.is_number_unsigned() &&
                      json.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max();
  if (json.is_number_integer() && !beyond) {
    const auto number = json.get<std::int64_t>();
    if (number >= least && number <= most) return number;
  }
  throw ConfigError(fmt::format("got {:.60}; expected a whole number from {} to {}", JsonText(json),
                                least, most));
}

}  // namespace oca::internal
