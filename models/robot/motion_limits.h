// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/motion/stoppable_motion.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// The limits of joint position number `index`, for motions that can stop within them.
inline motion::JointLimits LimitsOf(const RobotModel& model, Eigen::Index index) {
  return {model.lower_limits()[index], model.upper_limits()[index], model.velocity_limits()[index],
          model.acceleration_limits()[index], model.jerk_limits()[index]};
}

}  // namespace oca::robot
