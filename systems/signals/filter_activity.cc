// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/filter_activity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"

namespace oca::systems {
namespace {

constexpr std::array kStatusNames{"optimal", "iteration_limit", "not_proven", "invalid"};
constexpr std::array kKindNames{"distance", "recovery", "lower", "upper", "unmovable"};

bool OfJoint(FilterBound::Kind kind) {
  return kind == FilterBound::Kind::kLower || kind == FilterBound::Kind::kUpper;
}

Json BoundToJson(const FilterBound& bound) {
  const char* kind = kKindNames[static_cast<int>(bound.kind)];
  if (OfJoint(bound.kind)) {
    return {{"kind", kind},
            {"joint", bound.link.text()},
            {"limit", NameOf(bound.limit)},
            {"multiplier", bound.multiplier}};
  }
  return {{"kind", kind},
          {"link", bound.link.text()},
          {"obstacle", bound.obstacle.text()},
          {"multiplier", bound.multiplier},
          {"slack", bound.slack}};
}

}  // namespace
}  // namespace oca::systems

namespace oca {

using systems::FilterActivity;

Fault Signal<FilterActivity>::Check(const FilterActivity& value, Look /*look*/) {
  const auto finite = [](const auto& bound) {
    return std::isfinite(bound.multiplier) && std::isfinite(bound.slack);
  };
  return Fault::UnlessFinite(
      std::isfinite(value.slack) && std::isfinite(value.margin) &&
      std::isfinite(value.kkt_residual) && std::isfinite(value.gap) &&
      std::all_of(value.bounds.begin(), value.bounds.begin() + value.num_bounds, finite));
}

void Signal<FilterActivity>::WriteJson(const FilterActivity& value, std::string& out) {
  systems::Json json = {{"status", systems::kStatusNames[static_cast<int>(value.status)]},
                        {"rows", value.rows},
                        {"dropped", value.dropped},
                        {"yields", value.yields},
                        {"slack", value.slack},
                        {"margin", value.margin},
                        {"kkt_residual", value.kkt_residual},
                        {"gap", value.gap},
                        {"bounds", systems::Json::array()}};
  for (int i = 0; i < value.num_bounds; ++i)
    json["bounds"].push_back(systems::BoundToJson(value.bounds[i]));
  out += oca::internal::JsonText(json);
}

}  // namespace oca
