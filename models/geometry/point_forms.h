// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "oca/models/geometry/collider.h"

namespace oca::geometry::internal {

/// Where a point lies as seen from a core: signed distance (m, negative inside), the nearest point
/// of the surface, and the outward unit normal there. Frame of the core.
/// `point - nearest = distance * normal`.
struct Outside {
  double distance;
  Eigen::Vector3d nearest;
  Eigen::Vector3d normal;
};

/// By algebra, for every core but kCompound; of a hull only from inside, see OutsideOfHull.
///
/// Where the direction is not unique (the middle of a box, a point on an axis) one of the shortest
/// is taken, always the same one.
/// source Ericson 2005, chapter 5; Eberly, Distance from a Point to an Ellipsoid, 2013
Outside OutsideOf(const Collider& core, const Eigen::Vector3d& point);

/// The plane of a hull that a point is least below. Exact inside; outside a lower bound.
Outside OutsideOfHull(const ConvexHull& hull, const Eigen::Vector3d& point);

}  // namespace oca::geometry::internal
