// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <span>

#include "oca/models/robot/filtered_inverse.h"
#include "oca/models/robot/proximity.h"

namespace oca::robot {

/// How fast a request is followed near obstacles, as a share of its own speed:
///
///     scale(d) = 1 for d >= slow_distance
///                exp(k (d - slow_distance)),  k = ln(1000) / slow_distance
///                0 for d <= 0
///
/// between two links of the arm with the lesser of `own_slow_distance` and what is asked of the
/// pair instead. With `approach_only` a motion that leads away is not slowed:
///
///     scale_i = 1 - fade (1 - scale(d_i)),   fade from 0 to 1 while -n_i^T J_i dr/ds goes from 0
///                                            to 0.02 m/s
///
/// source MoveIt Servo, collision_monitor.cpp; docs/theory.md
struct ServoScalingLaw {
  double slow_distance;      ///< m
  double own_slow_distance;  ///< m
  bool approach_only;

  /// At a distance from an obstacle, or with `own` from another link of the arm, of which no more
  /// than `range` is asked.
  double ScaleAt(double distance, bool own,
                 double range = std::numeric_limits<double>::infinity()) const;
  /// Near one thing, `rate` being dr/ds. throws ModelError if it is of no link of the model
  double Scale(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
               const Proximity& proximity, const JointVector& rate) const;
};

}  // namespace oca::robot
