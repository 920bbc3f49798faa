// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "oca/models/geometry/convex_hull.h"

namespace oca::geometry::internal {

/// Index of the vertex farthest along `direction`; a linear search, which beats hill climbing up to
/// several hundred vertices. Uses AVX2 where the machine has it.
int FarthestVertex(const ConvexHull& hull, const Eigen::Vector3d& direction);

/// The same without vector instructions; what the test compares with.
int FarthestVertexPortable(const ConvexHull& hull, const Eigen::Vector3d& direction);

}  // namespace oca::geometry::internal
