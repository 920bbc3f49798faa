// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/param_numbers.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace oca::internal {
namespace {

using nlohmann::ordered_json;

std::string WithUnit(const FieldInfo& field) { return field.unit.empty() ? "" : " " + field.unit; }

void AddBounds(const Bounds& bounds, ordered_json& schema) {
  if (std::isfinite(bounds.lower)) {
    schema[bounds.above ? "exclusiveMinimum" : "minimum"] = bounds.lower;
  }
  if (std::isfinite(bounds.upper)) schema["maximum"] = bounds.upper;
}

std::string BeyondBounds(double number, const FieldInfo& field, const std::string& where) {
  return fmt::format("{}: got {}{}; expected {}", where, number, WithUnit(field),
                     field.bounds.ToString());
}

}  // namespace

std::string NameOfItem(const std::string& where, std::size_t i) {
  return where + "[" + std::to_string(i) + "]";
}

void AddMismatch(const Value& value, const std::string& where, const std::string& expected,
                 Problems& problems) {
  problems.Add(value.location(),
               fmt::format("{}: got {}; expected {}", where, value.Show(), expected));
}

void CheckNumber(double number, const FieldInfo& field, const std::string& where,
                 std::vector<std::string>& problems) {
  if (!std::isfinite(number)) {
    problems.push_back(fmt::format("{}: got {}; expected a finite number", where, number));
  } else if (!field.bounds.Contains(number)) {
    problems.push_back(BeyondBounds(number, field, where));
  }
}

bool ReadNumber(const Value& value, const FieldInfo& field, const std::string& where, double& out,
                Problems& problems) {
  double number = 0.0;
  if (!value.number(number)) {
    AddMismatch(value, where, "a number" + (field.unit.empty() ? "" : " in " + field.unit),
                problems);
    return false;
  }
  if (!std::isfinite(number)) {
    AddMismatch(value, where, "a finite number", problems);
    return false;
  }
  if (!field.bounds.Contains(number)) {
    problems.Add(value.location(), BeyondBounds(number, field, where));
    return false;
  }
  out = number;
  return true;
}

ordered_json NumberSchema(const FieldInfo& field, const char* type) {
  ordered_json schema{{"type", type}};
  AddBounds(field.bounds, schema);
  return schema;
}

ordered_json NumberJson(double number) {
  constexpr double kExact = 9007199254740992.0;  // whole numbers up to it are exact
  if (!std::isfinite(number)) return {};
  if (number == std::floor(number) && std::fabs(number) < kExact) {
    return static_cast<std::int64_t>(number);
  }
  return number;
}

}  // namespace oca::internal
