// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Something that a robot holds or wears: a tool, a grasped box.
struct AttachedObject {
  std::string id{};
  std::string link{};                                     ///< that carries it
  Eigen::Isometry3d X_LO{Eigen::Isometry3d::Identity()};  ///< of the shape's frame in that link
  geometry::Shape shape{};
  std::vector<std::string> touches{};  ///< links and earlier objects that it may touch
};

/// The robot with each object as one more link of that name, fixed to its carrier: it moves with
/// the carrier, collides with whatever the carrier's links collide with, and is drawn.
///
/// It may touch its carrier, what is rigidly connected to that, and `touches`; pairs with all other
/// links of the robot are checked, neighbours across a joint included. Positions, and the numbers
/// of links and joints that were there before, stay the same.
/// throws ModelError if an id is empty or taken, or a link to carry or to touch does not exist
RobotModel AttachObjects(const RobotModel& robot, std::span<const AttachedObject> objects);

}  // namespace oca::robot
