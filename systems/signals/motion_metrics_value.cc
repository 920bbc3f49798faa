// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/motion_metrics_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::Json;
using systems::JsonReader;
using systems::MotionMetricsValue;
using systems::MotionTally;

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

void ReadPair(const JsonReader& pair, models::Name& link, models::Name& obstacle) {
  std::array<std::string, 2> names;
  std::size_t count = 0;
  pair.ForEach([&](const JsonReader& item) {
    if (count < names.size()) names[count] = item.Label();
    ++count;
  });
  if (count != names.size()) pair.Fail("another length", "[link, obstacle]");
  link = models::Name(names[0]);
  obstacle = models::Name(names[1]);
}

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

MotionMetricsValue Signal<MotionMetricsValue>::ReadJson(std::string_view text) {
  const Json json = systems::ParseJson(text);
  const JsonReader reader(json, "metrics");
  reader.CheckKeys({"min_distance", kPair, "min_distance_time", "certified_min_distance",
                    "contact_time", "first_contact_time", "max_abs_delta", "final_error",
                    "time_to_goal", "delta_sign_changes_per_second", "total_variation_ratio",
                    "max_joint_speed", "max_joint_acceleration", "limit_violations", "stuck_time",
                    kStuckPair});
  MotionMetricsValue value;
  for (const auto& [key, member] : kNumbers) {
    if (!json[key].is_null()) value.*member = reader.At(key).Number();
  }
  if (!json[kPair].is_null()) {
    ReadPair(reader.At(kPair), value.min_distance_link, value.min_distance_obstacle);
  }
  if (!json[kStuckPair].is_null()) {
    ReadPair(reader.At(kStuckPair), value.stuck_link, value.stuck_obstacle);
  }
  return value;
}

Fault Signal<MotionTally>::Check(const MotionTally& value, Look /*look*/) {
  const auto finite = [](const std::vector<double>& vector) {
    return AllFinite(vector.data(), static_cast<std::size_t>(vector.size()));
  };
  const std::array numbers{value.certified_,
                           value.reach_,
                           value.fastest_,
                           value.last_time_,
                           value.min_distance_.value_or(0.0),
                           value.contact_time_,
                           value.max_abs_delta_,
                           value.position_path_,
                           value.request_path_,
                           value.max_speed_,
                           value.max_acceleration_,
                           value.limit_violations_,
                           value.goal_time_.value_or(0.0),
                           value.stuck_time_};
  return Fault::UnlessFinite(AllFinite(numbers.data(), numbers.size()) && finite(value.position_) &&
                             finite(value.velocity_) && finite(value.request_) &&
                             finite(value.delta_));
}

void Signal<MotionTally>::WriteJson(const MotionTally& value, std::string& out) {
  out += fmt::format(R"({{"samples":{},"time":{}}})", value.samples_, value.last_time_);
}

MotionTally Signal<MotionTally>::ReadJson(std::string_view text) {
  const Json json = systems::ParseJson(text);
  const JsonReader reader(json, "tally");
  reader.CheckKeys({"samples", "time"});
  MotionTally tally;
  tally.samples_ = static_cast<int>(reader.At("samples").Number());
  tally.last_time_ = reader.At("time").Number();
  return tally;
}

}  // namespace oca
