// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace oca::internal {

inline constexpr int kDeepestJson = 64;  ///< levels

/// The tree of a JSON text of others. Trees are copied and written by recursion, so those that nest
/// deeper than kDeepestJson levels are refused; numbers beyond a double, too, and equal keys.
/// throws ConfigError `JSON: byte N: ...; got X; expected Y`
nlohmann::ordered_json ReadJsonTree(std::string_view text);

/// The whole number that a value is.
/// throws ConfigError `got X; expected a whole number from A to B`
std::int64_t WholeNumber(const nlohmann::ordered_json& json, std::int64_t least, std::int64_t most);
/// One that T holds.
template <class T>
T WholeNumber(const nlohmann::ordered_json& json) {
  return static_cast<T>(
      WholeNumber(json, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
}

/// The text of a tree. Texts in it may be no UTF-8, as names of files are: U+FFFD takes the place
/// of what is none.
template <class Json>
std::string JsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace oca::internal
