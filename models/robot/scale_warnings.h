// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// A line if the robot is as large as one whose lengths were meant as millimetres: if its frames
/// lie more than kLongestArm m beyond its first joint, along the joints, or else one for the first
/// moving link whose shape is much larger than that, as of a mesh without its scale.
std::vector<std::string> ScaleWarnings(const RobotModel& model);

inline constexpr double kLongestArm = 100.0;  // m

}  // namespace oca::robot
