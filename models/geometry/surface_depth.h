// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "oca/models/geometry/core_pair.h"
#include "oca/models/geometry/distance.h"

namespace oca::geometry::internal {

/// Depth of two cores that overlap, from four points of A - B around the origin.
/// Leaves its surface in `cache` (may be null).
///
/// A StarSurface grows towards the origin's nearest face, in doubles. False where they do not prove
/// the answer: flat tetrahedra, needles, a ring of equal exits. PolytopeDepth then knows more.
/// source van den Bergen 2001
bool SurfaceDepth(const CorePair& pair, std::span<const CorePair::Difference, 4> around,
                  PairCache* cache, CoreDistance* found);

/// The same from the surface that `cache` holds of the last query; drops that if it proves nothing.
bool KeptSurfaceDepth(const CorePair& pair, PairCache* cache, CoreDistance* found);

}  // namespace oca::geometry::internal
