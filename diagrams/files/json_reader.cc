// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/json_reader.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::files {
namespace {

Value FromJson(const nlohmann::ordered_json& json, const Location& location) {
  if (json.is_boolean()) return Value(json.get<bool>(), location);
  const bool beyond = json.is_number_unsigned() &&
                      json.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max();
  if (json.is_number_integer() && !beyond) return Value(json.get<std::int64_t>(), location);
  if (json.is_number()) return Value(json.get<double>(), location);
  if (json.is_string()) return Value(json.get<std::string>(), location);
  if (json.is_array()) {
    Value::List list;
    for (const auto& item : json) list.push_back(FromJson(item, location));
    return Value(std::move(list), location);
  }
  if (json.is_object()) {
    Value::Map map;
    for (const auto& [key, item] : json.items()) {
      map.push_back({key, location, FromJson(item, location)});
    }
    return Value(std::move(map), location);
  }
  throw ConfigError("null; expected a value");
}

}  // namespace

Value ReadJson(std::string_view text, const std::string& name) {
  const Location location{std::make_shared<const std::string>(name), 0, 0};
  try {
    return FromJson(oca::internal::ReadJsonTree(text), location);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: error: {}", name, error.what()));
  }
}

}  // namespace oca::files
