// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Signed distance of two cores that overlap or touch: minus the least height of the origin below
/// the planes that bound A - B.
///
/// A polytope inside A - B grows towards the origin's nearest face until that face is one of A - B
/// itself. It grows on an integer lattice with exact predicates, so no flat or thin face misleads
/// it; polyhedral pairs end at the true face, curved ones when `gap` is below
/// 1e-10 of their size or 256 vertices are used up.
/// Works on about 200 kB of stack. `hint` (frame of A, zero if none) is a direction in which
/// another method found an exit.
/// source van den Bergen 2001
CoreDistance PolytopeDepth(const CorePair& pair, const Eigen::Vector3d& hint);

}  // namespace oca::geometry::internal
