// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "oca/models/scenes/planning_scene.h"

namespace oca::scenes {

/// Where a link shall be, in a frame of the scene.
struct RequestedPose {
  PlacedName link{};
  PlacedName frame{};                                 ///< empty: that of the scene
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  ///< of the link's origin + offset, m
  Eigen::Vector3d offset{Eigen::Vector3d::Zero()};    ///< in the link's frame, m
  std::optional<Eigen::Quaterniond> rotation{};       ///< none: it may turn freely
  PlacedName rotation_frame{};
  std::string where{};
};

/// What MoveIt calls a motion plan request, as far as it says from where to where.
struct MotionRequest {
  std::string file{};
  std::string group{};  ///< empty: not said
  JointPositions start{};
  JointPositions goal{};                ///< of a goal of joints
  std::optional<RequestedPose> pose{};  ///< of a goal of a pose, instead
  /// What the file says and is not taken over, a line each: `file:line: what: why`.
  std::vector<std::string> notes{};
};

/// Reads a moveit_msgs/MotionPlanRequest in YAML.
/// throws ModelError `file:line: what; got X; expected Y`: for what is not of the format, no goal
///        or several, one of joints and of a pose at once, a joint that is constrained twice, an
///        orientation without a position, joints and positions of different number
/// source moveit_msgs MotionPlanRequest, Constraints
MotionRequest ReadMotionRequest(const std::filesystem::path& file);

}  // namespace oca::scenes
