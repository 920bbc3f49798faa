// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/robot/motion_metrics.h"

namespace oca::systems {

/// JSON: an object with every metric, null where there is no value; min_distance_pair and
/// stuck_pair are [link, obstacle], the latter perhaps [joint, "limit"].
using robot::MotionMetricsValue;

/// A metric by its name: a number, a pair [link, obstacle], or nothing.
struct Metric {
  using Value = std::variant<std::monostate, double, std::array<models::Name, 2>>;
  std::string_view name;
  Value value{};
  /// The number; none if it is something else.
  std::optional<double> number() const;
};
/// All of them, in the order of the JSON.
std::vector<Metric> MetricsIn(const MotionMetricsValue& value);
/// The metric of a name as a number; none if it has none, or there is no such metric.
std::optional<double> NumberIn(const MotionMetricsValue& value, std::string_view name);
/// Sets a metric. Returns false if there is none of that name that is such a value.
bool SetMetric(MotionMetricsValue& value, const Metric& metric);
/// The metrics of two judges as one: the nearest approach with its pair and time, the earliest
/// contact, and of everything else the largest; what both must have (time_to_goal,
/// certified_min_distance) only if both do.
MotionMetricsValue WorstOf(const MotionMetricsValue& one, const MotionMetricsValue& other);

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::MotionMetricsValue> {
  static constexpr const char* kName = "MotionMetrics";
  static Fault Check(const systems::MotionMetricsValue& value, Look look);
  static void WriteJson(const systems::MotionMetricsValue& value, std::string& out);
};

}  // namespace oca
