// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/servo_scaling_law.h"

#include <algorithm>
#include <cmath>

#include "oca/models/robot/avoidance_velocity.h"

namespace oca::robot {
namespace {

const double kFallOff = std::log(1000.0);  // the scale at contact is 1/1000
// An approach that is slowed in full, m/s.
constexpr double kFullApproach = 0.02;

}  // namespace

double ServoScalingLaw::ScaleAt(double distance, bool own, double range) const {
  const double slow = std::min(own ? own_slow_distance : slow_distance, range);
  if (distance >= slow) return 1.0;
  return distance > 0.0 ? std::exp(kFallOff * (distance / slow - 1.0)) : 0.0;
}

double ServoScalingLaw::Scale(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                              const Proximity& proximity, const JointVector& rate) const {
  const double scale = ScaleAt(proximity.distance, !proximity.own_link.empty(), proximity.range);
  if (scale >= 1.0) return 1.0;
  double counts = 1.0;
  if (approach_only) {
    const double approach = -DistanceRow(model, X_WL, proximity).dot(rate);
    counts = Fade(-approach, -kFullApproach, 0.0);
  }
  return 1.0 - counts * (1.0 - scale);
}

}  // namespace oca::robot
