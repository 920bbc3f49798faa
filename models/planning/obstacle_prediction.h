// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "oca/models/geometry/obstacle.h"

namespace oca::planning {

// What obstacles do that go on as they do now.

/// Slower than 1e-6 m/s and rad/s.
bool Stands(const geometry::Obstacle& obstacle);

/// The pose of an obstacle `ahead` s from now.
Eigen::Isometry3d Foreseen(const geometry::Obstacle& obstacle, double ahead);

/// Same bodies at the same places, all at rest. The capacity of `seen` may differ.
bool SameStanding(const std::vector<geometry::Obstacle>& seen,
                  const std::vector<geometry::Obstacle>& now);

/// Whether what was seen `since` s ago is where it was foreseen, to 5 mm now and in 0.3 s; a turn
/// counts at 0.5 m.
bool AsForeseen(const std::vector<geometry::Obstacle>& seen,
                const std::vector<geometry::Obstacle>& now, double since);

}  // namespace oca::planning
