// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/robot/motion_tally.h"

namespace oca::systems {

/// JSON: an object with every metric, null where there is no value; min_distance_pair and
/// stuck_pair are [link, obstacle].
using robot::MotionMetricsValue;

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::MotionMetricsValue> {
  static constexpr const char* kName = "MotionMetrics";
  static Fault Check(const systems::MotionMetricsValue& value, Look look);
  static void WriteJson(const systems::MotionMetricsValue& value, std::string& out);
};
template <>
struct Signal<robot::MotionTally> {
  static constexpr const char* kName = "MotionTally";
  static Fault Check(const robot::MotionTally& value, Look look);
};

}  // namespace oca
