// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "oca/framework/dataflow/value.h"

// Trees of parameters without places, for tests.

namespace oca::values {

inline Value Number(double number) { return Value(number, {}); }
inline Value Text(const char* text) { return Value(std::string(text), {}); }
inline Value ListOf(std::initializer_list<Value> items) { return Value(Value::List(items), {}); }
inline Value MapOf(std::initializer_list<std::pair<const char*, Value>> entries) {
  Value::Map map;
  for (const auto& [key, value] : entries) map.push_back({key, {}, value});
  return Value(std::move(map), {});
}

}  // namespace oca::values
