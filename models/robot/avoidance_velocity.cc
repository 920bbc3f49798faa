// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/avoidance_velocity.h"

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

JointVector DistanceRow(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                        const Proximity& proximity) {
  JointVector row(model.num_positions());
  DistanceRow(model, X_WL, proximity, row);
  return row;
}

}  // namespace oca::robot
