// SPDX-License-Identifier: BSD-3-Clause
// The parameter type `held` of a model, of diagram_file.h.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/files/diagram_file.h"

namespace oca {
namespace {

using nlohmann::ordered_json;

class HeldJointsType final : public ParamType {
 public:
  std::string Name() const override { return "map of numbers by joint, of states by group"; }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.map() == nullptr) {
      problems.Add(value.location(),
                   fmt::format("{}: got {}; expected a map of joints", where, value.Show()));
      return;
    }
    auto& held = *static_cast<files::HeldParams*>(target);
    for (const Value::Entry& entry : *value.map()) {
      if (entry.value.string() != nullptr) {
        held.states[entry.key] = *entry.value.string();
      } else if (double position = 0.0; entry.value.number(position)) {
        held.positions[entry.key] = position;
      } else {
        problems.Add(entry.value.location(),
                     fmt::format("{}.{}: got {}; expected where the joint is, rad or m, or of a "
                                 "group the name of a state",
                                 where, entry.key, entry.value.Show()));
      }
    }
  }
  void Check(const void* /*value*/, const FieldInfo& /*field*/, const std::string& /*where*/,
             std::vector<std::string>& /*problems*/) const override {}
  ordered_json ToJson(const void* value) const override {
    const auto& held = *static_cast<const files::HeldParams*>(value);
    ordered_json json = ordered_json::object();
    for (const auto& [group, state] : held.states) json[group] = state;
    for (const auto& [joint, position] : held.positions) json[joint] = position;
    return json;
  }
  ordered_json Schema(const FieldInfo& /*field*/) const override {
    return {{"type", "object"}, {"additionalProperties", {{"type", {"number", "string"}}}}};
  }
};

}  // namespace

template <>
const ParamType& ParamTypeOf<files::HeldParams>() {
  static const HeldJointsType type;
  return type;
}

}  // namespace oca
