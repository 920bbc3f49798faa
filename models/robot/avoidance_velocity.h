// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "oca/models/robot/filtered_inverse.h"
#include "oca/models/robot/proximity.h"

namespace oca::robot {

// What laws share that choose a joint velocity by the distances.

/// The joint velocity that a law chose, and how much say avoidance had.
struct AvoidanceVelocity {
  Eigen::VectorXd velocity{};
  double share{0.0};  ///< 0: the request's alone, 1: avoidance goes first
  int rows{0};        ///< proximities that took part
};

/// d(distance)/d(position) of every joint, of which there are at most kMostFilteredJoints. throws
/// ModelError if it is of no link of the model
JointVector DistanceRow(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                        const Proximity& proximity);

}  // namespace oca::robot
