// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/json_reader.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "oca/framework/dataflow/error.h"

namespace oca::files {
namespace {

constexpr int kDeepestJson = 64;

Value FromJson(const nlohmann::ordered_json& json, const Location& location, int depth) {
  if (depth > kDeepestJson)
    throw ConfigError(fmt::format("nested deeper than {} levels", kDeepestJson));
  if (json.is_boolean()) return Value(json.get<bool>(), location);
  const bool beyond = json.is_number_unsigned() &&
                      json.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max();
  if (json.is_number_integer() && !beyond) return Value(json.get<std::int64_t>(), location);
  if (json.is_number()) return Value(json.get<double>(), location);
  if (json.is_string()) return Value(json.get<std::string>(), location);
  if (json.is_array()) {
    Value::List list;
    for (const auto& item : json) list.push_back(FromJson(item, location, depth + 1));
    return Value(std::move(list), location);
  }
  if (json.is_object()) {
    Value::Map map;
    for (const auto& [key, item] : json.items()) {
      map.push_back({key, location, FromJson(item, location, depth + 1)});
    }
    return Value(std::move(map), location);
  }
  throw ConfigError("null; expected a value");
}

/// nlohmann keeps one of two equal keys without a word.
nlohmann::ordered_json ParseStrictly(std::string_view text) {
  using Json = nlohmann::ordered_json;
  std::vector<std::set<std::string>> open;
  const auto check = [&open](int /*depth*/, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key &&
        !open.back().insert(parsed.get<std::string>()).second) {
      throw ConfigError(fmt::format("{}: duplicate key", parsed.get<std::string>()));
    }
    return true;
  };
  return Json::parse(text, check);
}

}  // namespace

Value ReadJson(std::string_view text, const std::string& name) {
  const Location location{std::make_shared<const std::string>(name), 0, 0};
  try {
    return FromJson(ParseStrictly(text), location, 0);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: error: {}", name, error.what()));
  } catch (const nlohmann::json::exception& error) {
    const std::string what = error.what();
    const auto start = what.find("] ");
    throw ConfigError(fmt::format("{}: error: {}", name,
                                  start == std::string::npos ? what : what.substr(start + 2)));
  }
}

}  // namespace oca::files
