// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

using Triangle = std::array<const CorePair::Difference*, 3>;

/// Barycentric coordinates of the point where a ray from the origin meets the plane of a triangle
/// of A - B; all -1 if it does not.
Eigen::Vector3d RayWeights(const Triangle& triangle, const Eigen::Vector3d& ray);

/// The answer of an overlap: the points of the bodies behind the point of `triangle` where the ray
/// along `normal` (unit, out of A - B) meets it, and the plane across it, `depth` m away.
CoreDistance ExitPoint(const CorePair& pair, const Triangle& triangle,
                       const Eigen::Vector3d& normal, double depth, double gap);

}  // namespace oca::geometry::internal
