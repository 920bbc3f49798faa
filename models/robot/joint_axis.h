// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "oca/models/robot/robot_model.h"

namespace oca::robot::internal {

/// Axis of the joint that carries a link, world axes: of a joint along a coordinate axis, as nearly
/// all are, a column of the link's rotation, to the same digits.
inline Eigen::Vector3d JointAxis(const KinematicStep& step, const Eigen::Isometry3d& X_WL) {
  if (step.principal_axis < 3) return step.sign * X_WL.matrix().col(step.principal_axis).head<3>();
  return X_WL.linear() * step.axis;
}

}  // namespace oca::robot::internal
