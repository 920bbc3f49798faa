// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Links that are drawn but have no collision shape, so that no distance sees them, as link
/// numbers. A link with neither, as a frame of a tool, is no body.
std::vector<int> DrawnOnly(const RobotModel& model);

/// Whether no link that moves, or, of a model that cannot move, no link at all has a collision
/// shape. Attached objects do not count: they are not of the robot.
bool NothingToSee(const RobotModel& model);

/// Both as a line of a message; empty if every link that is drawn is seen. `remedy` is how the
/// reader of it asks for VisualAsCollision::kMissing.
std::string DescribeUnseen(const RobotModel& model, const std::string& remedy);

}  // namespace oca::robot
