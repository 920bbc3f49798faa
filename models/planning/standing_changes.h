// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/robot/robot_model.h"

namespace oca::planning {

/// A ball that the links of a robot never leave, wherever its joints are, world, m.
struct ReachBall {
  Eigen::Vector3d centre;
  double radius;
};
/// About the root link: no link is farther from it than the lengths between the joints on the way
/// add up to, and the range of sliders.
ReachBall ReachBallOf(const robot::RobotModel& model);

// What has changed of the obstacles at rest between two looks. A body that is farther than the
// reach of the robot counts for nothing.

/// Whether the same bodies stand at the same places, whatever moves besides.
bool SameRest(const std::vector<geometry::Obstacle>& seen,
              const std::vector<geometry::Obstacle>& now, const ReachBall& reach);
/// Whether each that stood stands where it stood: others may have come, which open no way.
bool AllStay(const std::vector<geometry::Obstacle>& seen,
             const std::vector<geometry::Obstacle>& now, const ReachBall& reach);
/// Names of those that stand where they stood, however far, into `names`.
void FindStill(const std::vector<geometry::Obstacle>& seen,
               const std::vector<geometry::Obstacle>& now, std::vector<models::Name>& names);

}  // namespace oca::planning
