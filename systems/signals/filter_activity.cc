// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/filter_activity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "oca/systems/methods/motion_limiter.h"
#include "oca/systems/signals/json_fields.h"

namespace oca::systems {
namespace {

constexpr std::array kStatusNames{"optimal", "iteration_limit", "not_proven", "invalid"};
constexpr std::array kKindNames{"distance", "recovery", "lower", "upper", "unmovable"};

/// The number of a text among `names`.
template <class Names>
int Find(const JsonReader& reader, const Names& names, const char* expected) {
  const std::string text = reader.Text();
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) reader.Fail("'" + text + "'", expected);
  return static_cast<int>(found - names.begin());
}

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

FilterBound ReadBound(const JsonReader& item) {
  FilterBound bound;
  bound.kind = static_cast<FilterBound::Kind>(
      Find(item.At("kind"), kKindNames, "distance, recovery, lower, upper or unmovable"));
  if (OfJoint(bound.kind)) {
    item.CheckKeys({"kind", "joint", "limit", "multiplier"});
    bound.link = models::Name(item.At("joint").Label());
    bound.limit = MotionLimitNamed(item.At("limit").Text());
  } else {
    item.CheckKeys({"kind", "link", "obstacle", "multiplier", "slack"});
    bound.link = models::Name(item.At("link").Label());
    bound.obstacle = models::Name(item.At("obstacle").Label());
    bound.slack = item.At("slack").Number();
  }
  bound.multiplier = item.At("multiplier").Number();
  return bound;
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
  out += json.dump();
}

FilterActivity Signal<FilterActivity>::ReadJson(std::string_view text) {
  const systems::Json json = systems::ParseJson(text);
  const systems::JsonReader reader(json, "activity");
  reader.CheckKeys(
      {"status", "rows", "dropped", "yields", "slack", "margin", "kkt_residual", "gap", "bounds"});
  FilterActivity value;
  value.status =
      static_cast<qp::QpStatus>(systems::Find(reader.At("status"), systems::kStatusNames,
                                              "optimal, iteration_limit, not_proven or invalid"));
  value.rows = static_cast<int>(reader.At("rows").Number());
  value.dropped = static_cast<int>(reader.At("dropped").Number());
  value.yields = static_cast<int>(reader.At("yields").Number());
  value.slack = reader.At("slack").Number();
  value.margin = reader.At("margin").Number();
  value.kkt_residual = reader.At("kkt_residual").Number();
  value.gap = reader.At("gap").Number();
  reader.At("bounds").ForEach([&](const systems::JsonReader& item) {
    if (value.num_bounds == FilterActivity::kMostBounds) {
      item.Fail("one more", fmt::format("at most {}", FilterActivity::kMostBounds));
    }
    value.bounds[value.num_bounds++] = systems::ReadBound(item);
  });
  return value;
}

}  // namespace oca
