// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

/// nlohmann keeps one of two equal keys without a word.
Json ParseStrictly(std::string_view text) {
  std::vector<std::set<std::string>> open;
  const auto check = [&open](int /*depth*/, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key &&
        !open.back().insert(parsed.get<std::string>()).second) {
      throw ConfigError(fmt::format("JSON: {}: duplicate key", parsed.get<std::string>()));
    }
    return true;
  };
  return Json::parse(text, check);
}

}  // namespace

Json ReadJsonTree(std::string_view text) {
  CheckLevels(text);
  try {
    return ParseStrictly(text);
  } catch (const Json::parse_error& error) {
    const std::size_t at = error.byte == 0 ? 0 : error.byte - 1;
    throw ConfigError(fmt::format("JSON: byte {}: syntax; got {}; expected valid JSON", at + 1,
                                  ShownFrom(text, at)));
  } catch (const Json::out_of_range&) {
    throw ConfigError("JSON: number; got one beyond 1.8e308; expected finite numbers");
  }
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
