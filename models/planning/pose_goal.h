// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/models/motion/key_points.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

/// Where a link of a robot shall be.
struct PoseGoal {
  Eigen::Isometry3d X_WG{Eigen::Isometry3d::Identity()};  ///< of the link, world
  bool turns_freely{false};                               ///< the link's origin alone is meant
  std::string link{};                                     ///< empty: the tip
  std::optional<double> time{};                           ///< s; of arrival
  double clearance{0.0};                                  ///< m; 0: nothing is looked at
  /// What there is to keep clear of at a time, s; may be empty.
  std::function<std::vector<robot::PlacedBody>(double time)> bodies{};
};

/// The key point that reaches the goal from the point before: of some twenty postures that do, the
/// one nearest to that point's. With a clearance, one that is so far from the bodies that are there
/// at `time` (without one: at the point before) and from the robot's other links, or as far as it
/// can. Without `time` it is reached when no joint needs more than a quarter of its speed limit on
/// the average, after 1 s at the earliest. The same goal gives the same key point.
/// throws ModelError `goal...: ...` if the goal is out of reach, telling the nearest that is not;
///        if there is no such link, or several tips and none named; if `time` is not after the
///        point before, or missing where a joint that moves has no speed limit; if that point is
///        of another length than the robot's positions; if distances see nothing of the robot
/// source models/robot/inverse_kinematics.h
motion::KeyPoint KeyPointAt(const PoseGoal& goal, const motion::KeyPoint& before,
                            const std::shared_ptr<const robot::RobotModel>& model);

}  // namespace oca::planning
