// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/motion_metrics_value.h"

#include <algorithm>
#include <array>

#include "oca/framework/dataflow/json_text.h"
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
    NumberField{"path_length", &MotionMetricsValue::path_length},
    NumberField{"max_joint_speed", &MotionMetricsValue::max_joint_speed},
    NumberField{"final_speed", &MotionMetricsValue::final_speed},
    NumberField{"max_joint_acceleration", &MotionMetricsValue::max_joint_acceleration},
    NumberField{"limit_violations", &MotionMetricsValue::limit_violations},
    NumberField{"stuck_time", &MotionMetricsValue::stuck_time},
    NumberField{"stuck_amount", &MotionMetricsValue::stuck_amount}};

constexpr const char* kPair = "min_distance_pair";
constexpr const char* kStuckPair = "stuck_pair";

Json ToJson(const systems::Metric::Value& value) {
  if (const double* const number = std::get_if<double>(&value)) return Json(*number);
  const auto* const pair = std::get_if<std::array<models::Name, 2>>(&value);
  return pair == nullptr ? Json() : Json{(*pair)[0].text(), (*pair)[1].text()};
}

}  // namespace

namespace systems {

std::optional<double> Metric::number() const {
  const double* const one = std::get_if<double>(&value);
  return one == nullptr ? std::nullopt : std::optional(*one);
}

std::vector<Metric> MetricsIn(const MotionMetricsValue& value) {
  std::vector<Metric> metrics;
  const auto add_pair = [&](const char* name, bool known, models::Name link,
                            models::Name obstacle) {
    metrics.push_back({name});
    if (known) metrics.back().value = std::array{link, obstacle};
  };
  for (const auto& [key, member] : kNumbers) {
    metrics.push_back({key});
    if (const auto& number = value.*member) metrics.back().value = *number;
    if (member == &MotionMetricsValue::min_distance) {
      add_pair(kPair, value.min_distance.has_value(), value.min_distance_link,
               value.min_distance_obstacle);
    }
  }
  add_pair(kStuckPair, !value.stuck_link.empty(), value.stuck_link, value.stuck_obstacle);
  return metrics;
}

std::optional<double> NumberIn(const MotionMetricsValue& value, std::string_view name) {
  const auto found = std::find_if(kNumbers.begin(), kNumbers.end(),
                                  [name](const NumberField& field) { return field.key == name; });
  return found == kNumbers.end() ? std::nullopt : value.*found->member;
}

bool SetMetric(MotionMetricsValue& value, const Metric& metric) {
  const bool nothing = std::holds_alternative<std::monostate>(metric.value);
  for (const auto& [key, member] : kNumbers) {
    if (metric.name != key) continue;
    value.*member = metric.number();
    return nothing || metric.number();
  }
  const bool nearest = metric.name == kPair;
  if (!nearest && metric.name != kStuckPair) return false;
  const auto* const pair = std::get_if<std::array<models::Name, 2>>(&metric.value);
  (nearest ? value.min_distance_link : value.stuck_link) =
      pair == nullptr ? models::Name() : (*pair)[0];
  (nearest ? value.min_distance_obstacle : value.stuck_obstacle) =
      pair == nullptr ? models::Name() : (*pair)[1];
  return nothing || pair != nullptr;
}

MotionMetricsValue WorstOf(const MotionMetricsValue& one, const MotionMetricsValue& other) {
  MotionMetricsValue worst = one;
  for (const auto& [key, member] : kNumbers) {
    const auto& a = one.*member;
    const auto& b = other.*member;
    if (b && (!a || *b > *a)) worst.*member = b;
  }
  const bool nearer =
      other.min_distance && (!one.min_distance || *other.min_distance < *one.min_distance);
  const MotionMetricsValue& nearest = nearer ? other : one;
  worst.min_distance = nearest.min_distance;
  worst.min_distance_link = nearest.min_distance_link;
  worst.min_distance_obstacle = nearest.min_distance_obstacle;
  worst.min_distance_time = nearest.min_distance_time;
  const MotionMetricsValue& stuck = worst.stuck_time != one.stuck_time ? other : one;
  worst.stuck_amount = stuck.stuck_amount;
  worst.stuck_link = stuck.stuck_link;
  worst.stuck_obstacle = stuck.stuck_obstacle;
  const auto least_of_both = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a && b ? std::optional(std::min(*a, *b)) : std::nullopt;
  };
  if (one.first_contact_time && other.first_contact_time) {
    worst.first_contact_time = least_of_both(one.first_contact_time, other.first_contact_time);
  }
  if (!one.time_to_goal || !other.time_to_goal) worst.time_to_goal.reset();
  worst.certified_min_distance =
      least_of_both(one.certified_min_distance, other.certified_min_distance);
  return worst;
}

}  // namespace systems

Fault Signal<MotionMetricsValue>::Check(const MotionMetricsValue& value, Look /*look*/) {
  return Fault::UnlessFinite(
      std::all_of(kNumbers.begin(), kNumbers.end(), [&](const NumberField& field) {
        const auto& number = value.*field.member;
        return !number || AllFinite(&*number, 1);
      }));
}

void Signal<MotionMetricsValue>::WriteJson(const MotionMetricsValue& value, std::string& out) {
  Json json;
  for (const systems::Metric& metric : systems::MetricsIn(value)) {
    json[std::string(metric.name)] = ToJson(metric.value);
  }
  out += oca::internal::JsonText(json);
}

}  // namespace oca
