// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/dataflow/param_numbers.h"

namespace oca {
namespace {

using internal::AddMismatch;
using internal::ReadNumber;
using nlohmann::ordered_json;

/// Looking does not write; the accessor serves reading too.
const void* MemberOf(const Field& field, const void* params) {
  return field.member(const_cast<void*>(params));
}

/// `frequency` (Hz) instead of `period`. Returns whether it stood there.
bool ReadFrequency(const Value& map, const Field& field, const std::string& prefix, void* params,
                   Problems& problems) {
  const Value* const value = map.Find("frequency");
  if (value == nullptr) return false;
  if (map.Find(field.key) != nullptr) {
    problems.Add(
        value->location(),
        fmt::format("{}frequency: got it beside {}; expected one of the two", prefix, field.key));
    return true;
  }
  FieldInfo info{"frequency", "Hz", "", false, {.lower = 0.0, .above = true}};
  double hertz = 0.0;
  if (!ReadNumber(*value, info, prefix + "frequency", hertz, problems)) return true;
  try {
    const Period inverse = Period::FromSeconds(hertz);
    *static_cast<Period*>(field.member(params)) =
        Period(inverse.denominator(), inverse.numerator());
  } catch (const ConfigError&) {
    AddMismatch(*value, prefix + "frequency", "a ratio of integers", problems);
  }
  return true;
}

}  // namespace

bool ParamType::Same(const void* a, const void* b) const { return ToJson(a) == ToJson(b); }

std::string Bounds::ToString() const {
  const bool below = std::isfinite(upper);
  if (std::isfinite(lower) && below) {
    return fmt::format("in {}{}, {}]", above ? "(" : "[", lower, upper);
  }
  if (std::isfinite(lower)) return fmt::format("{} {}", above ? ">" : ">=", lower);
  return below ? fmt::format("<= {}", upper) : "";
}

void ReadFields(const Value& value, const std::vector<Field>& fields, const std::string& where,
                void* params, Problems& problems) {
  const std::string prefix = where.empty() ? "" : where + ".";
  static const Value::Map kEmpty;
  if (value.map() == nullptr && !value.null()) {
    return AddMismatch(value, where.empty() ? "parameters" : where, "a map", problems);
  }
  std::vector<std::string> keys;
  for (const Field& field : fields) {
    keys.push_back(field.key);
    if (field.key == "period" && field.type == &ParamTypeOf<Period>()) {
      keys.emplace_back("frequency");
      if (ReadFrequency(value, field, prefix, params, problems)) continue;
    }
    if (const Value* const given = value.Find(field.key)) {
      if (given->null()) continue;  // whoever read the tree has said so
      field.type->Read(*given, field, prefix + field.key, field.member(params), problems);
    } else if (field.required) {
      problems.Add(value.location(), fmt::format("{}{}: missing; expected {}", prefix, field.key,
                                                 field.type->Name()));
    }
  }
  for (const Value::Entry& entry : value.map() == nullptr ? kEmpty : *value.map()) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    problems.Add(entry.location,
                 fmt::format("{}{}: unknown key{}; known: {}", prefix, entry.key,
                             DidYouMean(entry.key, keys),
                             keys.empty() ? "none" : fmt::format("{}", fmt::join(keys, ", "))));
  }
}

void CheckFields(const std::vector<Field>& fields, const void* params, const void* defaults,
                 const std::string& where, std::vector<std::string>& problems) {
  for (const Field& field : fields) {
    const void* const value = MemberOf(field, params);
    std::vector<std::string> any;
    field.type->Check(value, field, field.key, any);
    if (any.empty()) continue;
    if (!field.required && field.type->Same(value, MemberOf(field, defaults))) continue;
    field.type->Check(value, field, where.empty() ? field.key : where + "." + field.key, problems);
  }
}

namespace internal {

void ThrowProblems(const std::vector<std::string>& problems) {
  if (!problems.empty()) throw ConfigError(fmt::format("{}", fmt::join(problems, "\n")));
}

}  // namespace internal

ordered_json JsonOfFields(const std::vector<Field>& fields, const void* params) {
  ordered_json json = ordered_json::object();
  for (const Field& field : fields) {
    ordered_json value = field.type->ToJson(MemberOf(field, params));
    if (!value.is_null()) json[field.key] = std::move(value);
  }
  return json;
}

ordered_json SchemaOfFields(const std::vector<Field>& fields, const void* defaults) {
  ordered_json properties = ordered_json::object();
  ordered_json required = ordered_json::array();
  for (const Field& field : fields) {
    ordered_json schema = field.type->Schema(field);
    schema["description"] =
        field.unit.empty() ? field.meaning : fmt::format("{} [{}]", field.meaning, field.unit);
    if (!field.unit.empty()) schema["x-unit"] = field.unit;
    if (field.required) {
      required.push_back(field.key);
    } else {
      const ordered_json shown = field.type->ToJson(MemberOf(field, defaults));
      if (!shown.is_null()) schema["default"] = shown;
    }
    properties[field.key] = std::move(schema);
    if (field.key == "period" && field.type == &ParamTypeOf<Period>()) {
      properties["frequency"] = {{"type", "number"},
                                 {"exclusiveMinimum", 0},
                                 {"description", "instead of period [Hz]"},
                                 {"x-unit", "Hz"}};
      if (field.required) required.erase(required.size() - 1);
    }
  }
  ordered_json schema{
      {"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

}  // namespace oca
