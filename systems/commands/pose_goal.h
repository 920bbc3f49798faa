// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/models/motion/key_points.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "oca/systems/sensing/pose_params.h"

namespace oca::robot {
class RobotModel;
}  // namespace oca::robot

namespace oca::systems {

/// A planning::PoseGoal as a parameter of whoever moves joints. Of `pose` and `point` one is given.
struct PoseGoalParams {
  std::optional<PoseParams> pose{};              ///< of the link, world frame
  std::optional<Eigen::Vector3d> point{};        ///< m, world frame; or of its origin alone
  std::string link{};                            ///< empty: the tip
  std::optional<double> time{};                  ///< s; of arrival
  double clearance{0.0};                         ///< m
  std::vector<ObstacleSource::Params> around{};  ///< what there is to keep clear of
  static void Describe(Fields<PoseGoalParams>& fields);
};

/// planning::KeyPointAt, among the obstacles of `around`.
/// throws ConfigError as that, and for wrong poses and obstacles
motion::KeyPoint KeyPointAt(const PoseGoalParams& params, const motion::KeyPoint& before,
                            const std::shared_ptr<const robot::RobotModel>& model);

}  // namespace oca::systems
