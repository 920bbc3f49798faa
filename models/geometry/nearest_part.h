// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/distance.h"

namespace oca::geometry::internal {

/// Distance as models::Distance gives it, of a convex body A that ends and a compound B with
/// part_balls(). Parts are found through the tree of their balls, so that those far from A, however
/// many, cost next to nothing.
SignedDistance DistanceToNearestPart(const Collider& a, const Eigen::Isometry3d& X_WA,
                                     const Collider& b, const Eigen::Isometry3d& X_WB,
                                     double max_distance);

}  // namespace oca::geometry::internal
