// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/systems/commands/key_points.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/obstacle_source.h"

namespace oca::robot {
class RobotModel;
}  // namespace oca::robot

namespace oca::systems {

/// Where a link of a robot shall be, as a parameter of whoever moves joints.
struct PoseGoal {
  PoseParams pose{};                             ///< of the link, world frame
  std::string link{};                            ///< empty: the tip
  std::optional<double> time{};                  ///< s; of arrival
  double clearance{0.0};                         ///< m
  std::vector<ObstacleSource::Params> around{};  ///< what there is to keep clear of
  static void Describe(Fields<PoseGoal>& fields);
};

/// The key point that reaches the goal from the point before: of some twenty postures that do, the
/// one nearest to that point's. With a clearance, one that is so far from the obstacles that are
/// there at `time` and from the robot's other links, or as far as it can. Without `time` it is
/// reached when no joint needs more than a quarter of its speed limit on the average, after 1 s at
/// the earliest. The same goal gives the same key point.
/// throws ConfigError if the goal is out of reach, telling the nearest that is not; if there is no
///        such link, or several tips and none named; if `time` is not after the point before, or
///        missing where a joint that moves has no speed limit; for wrong poses and obstacles
/// source models/robot/inverse_kinematics.h
KeyPoint KeyPointAt(const PoseGoal& goal, const KeyPoint& before,
                    const std::shared_ptr<const robot::RobotModel>& model);

}  // namespace oca::systems
