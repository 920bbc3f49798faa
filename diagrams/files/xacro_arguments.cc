// SPDX-License-Identifier: BSD-3-Clause
// The parameter type `arguments` of a model in xacro, of diagram_file.h.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "oca/diagrams/files/diagram_file.h"

namespace oca {
namespace {

using nlohmann::ordered_json;

/// A value as its text in `name:=value`.
std::optional<std::string> ArgumentText(const Value& value) {
  if (value.string() != nullptr) return *value.string();
  if (value.boolean() != nullptr) return *value.boolean() ? "true" : "false";
  if (value.integer() != nullptr) return fmt::format("{}", *value.integer());
  double number = 0.0;
  if (!value.number(number)) return std::nullopt;
  const std::string text = fmt::format("{}", number);
  return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

class XacroArgumentsType final : public ParamType {
 public:
  std::string Name() const override { return "map of texts, numbers, booleans"; }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.map() == nullptr) {
      problems.Add(value.location(),
                   fmt::format("{}: got {}; expected a map of arguments", where, value.Show()));
      return;
    }
    auto& arguments = static_cast<files::XacroArguments*>(target)->texts;
    for (const Value::Entry& entry : *value.map()) {
      if (const auto text = ArgumentText(entry.value)) {
        arguments[entry.key] = *text;
        continue;
      }
      problems.Add(entry.value.location(),
                   fmt::format("{}.{}: got {}; expected a text, number or boolean", where,
                               entry.key, entry.value.Show()));
    }
  }
  void Check(const void* /*value*/, const FieldInfo& /*field*/, const std::string& /*where*/,
             std::vector<std::string>& /*problems*/) const override {}
  ordered_json ToJson(const void* value) const override {
    return static_cast<const files::XacroArguments*>(value)->texts;
  }
  ordered_json Schema(const FieldInfo& /*field*/) const override {
    return {{"type", "object"},
            {"additionalProperties", {{"type", {"string", "number", "boolean"}}}}};
  }
};

}  // namespace

template <>
const ParamType& ParamTypeOf<files::XacroArguments>() {
  static const XacroArgumentsType type;
  return type;
}

}  // namespace oca
