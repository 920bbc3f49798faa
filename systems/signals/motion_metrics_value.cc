// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/motion_metrics_value.h"

#include <algorithm>
#include <array>

#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::Json;
using systems::MotionMetricsValue;

namespace {

using Member = std::optional<double> MotionMetricsValue::*;

struct NumberField {
  const char* key;
  Member member;
};

// In the order of the JSON; the pairs stand after the first and the last.
constexpr std::array kNumbers{
    NumberField{"min_distance", &MotionMetricsValue::min_distance},
    NumberField{"min_distance_time", &MotionMetricsValue::min_distance_time},
    NumberField{"certified_min_distance", &MotionMetricsValue::certified_min_distance},
    NumberField{"contact_time", &MotionMetricsValue::contact_time},
    NumberField{"first_contact_time", &MotionMetricsValue::first_contact_time},
    NumberField{"max_abs_delta", &MotionMetricsValue::max_abs_delta},
    NumberField{"final_error", &MotionMetricsValue::final_error},
    NumberField{"time_to_goal", &MotionMetricsValue::time_to_goal},
    NumberField{"delta_sign_changes_per_second",
                &MotionMetricsValue::delta_sign_changes_per_second},
    NumberField{"total_variation_ratio", &MotionMetricsValue::total_variation_ratio},
    NumberField{"max_joint_speed", &MotionMetricsValue::max_joint_speed},
    NumberField{"max_joint_acceleration", &MotionMetricsValue::max_joint_acceleration},
    NumberField{"limit_violations", &MotionMetricsValue::limit_violations},
    NumberField{"stuck_time", &MotionMetricsValue::stuck_time}};

constexpr const char* kPair = "min_distance_pair";
constexpr const char* kStuckPair = "stuck_pair";

}  // namespace

Fault Signal<MotionMetricsValue>::Check(const MotionMetricsValue& value, Look /*look*/) {
  return Fault::UnlessFinite(
      std::all_of(kNumbers.begin(), kNumbers.end(), [&](const NumberField& field) {
        const auto& number = value.*field.member;
        return !number || AllFinite(&*number, 1);
      }));
}

void Signal<MotionMetricsValue>::WriteJson(const MotionMetricsValue& value, std::string& out) {
  Json json;
  for (const auto& [key, member] : kNumbers) {
    const auto& number = value.*member;
    json[key] = number ? Json(*number) : Json();
    if (member != &MotionMetricsValue::min_distance) continue;
    json[kPair] =
        number ? Json{value.min_distance_link.text(), value.min_distance_obstacle.text()} : Json();
  }
  json[kStuckPair] = value.stuck_link.empty()
                         ? Json()
                         : Json{value.stuck_link.text(), value.stuck_obstacle.text()};
  out += json.dump();
}

Fault Signal<robot::MotionTally>::Check(const robot::MotionTally& value, Look /*look*/) {
  return Fault::UnlessFinite(value.finite());
}

}  // namespace oca
