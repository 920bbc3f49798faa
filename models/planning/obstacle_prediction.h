// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "oca/models/geometry/obstacle.h"

namespace oca::planning {

// What obstacles are likely to do. Of what is known exactly, that is that they go on as they do
// now; of what was estimated (geometry::ObstacleEstimate) also that they turn, brake, get faster or
// fall. Lists of estimates have an entry an obstacle, or none.

/// Known to be slower than 1e-6 m/s and rad/s.
bool Stands(const geometry::Obstacle& obstacle);

/// The pose of an obstacle `ahead` s from now, if it goes on.
Eigen::Isometry3d Foreseen(const geometry::Obstacle& obstacle, double ahead);

/// Where an obstacle is likely to be some time ahead, and how fast.
struct LikelyState {
  Eigen::Isometry3d X_WO;
  Eigen::Vector3d linear;  ///< m/s
};
/// The likely motion with the estimated acceleration a: what falls, a within 2.5 m/s^2 of that of
/// gravity, keeps it; else the part across the velocity turns it, at the rate |a_n| / |v| up to 2
/// rad, and the part along it fades within 0.5 s, or ends when the body has stopped.
LikelyState LikelyAhead(const geometry::Obstacle& obstacle,
                        const geometry::ObstacleEstimate& estimate, double ahead);

/// How velocities changed that are known exactly, from one look to the next.
struct VelocityChanges {
  std::vector<const geometry::ObstacleBody*> bodies{};
  std::vector<Eigen::Vector3d> rates{};  ///< m/s^2; zero for a jump
};
/// Estimates without covariance of what was seen `dt` s before too, with the acceleration that its
/// velocity shows at two looks, one after the other: to within 1 m/s^2 and a fifth, so that no jump
/// counts; what changes by more than 20 m/s^2 is one. A fall, to within 1 m/s^2 of gravity, counts
/// at the first look. None if nothing accelerates. `changes` goes
/// from look to look.
std::vector<geometry::ObstacleEstimate> Accelerations(const std::vector<geometry::Obstacle>& before,
                                                      const std::vector<geometry::Obstacle>& now,
                                                      double dt, VelocityChanges& changes);

/// Covariance of the position that a plan counts on `ahead` s from now, m^2: grown for at most 0.3
/// s, what comes later is seen anew before.
Eigen::Matrix3d CovarianceAhead(const geometry::ObstacleEstimate& estimate, double ahead);

/// Same bodies at the same places, all at rest. The capacity of `seen` may differ. Places of what
/// was estimated may differ by what they are uncertain.
bool SameStanding(const std::vector<geometry::Obstacle>& seen,
                  const std::vector<geometry::Obstacle>& now,
                  std::span<const geometry::ObstacleEstimate> estimates = {});

/// What was known of obstacles at a time, and of what.
struct SeenObstacles {
  const std::vector<geometry::Obstacle>& obstacles;
  std::span<const geometry::ObstacleEstimate> estimates{};
};
/// Whether what was seen `since` s ago is where it was foreseen, to 5 mm now and in 0.3 s; a turn
/// counts at 0.5 m. Of what was estimated, to 5 mm and what it is uncertain. Not if a velocity is
/// not known.
bool AsForeseen(const SeenObstacles& seen, const SeenObstacles& now, double since);

}  // namespace oca::planning
