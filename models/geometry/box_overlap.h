// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Signed distance of two boxes that overlap or touch: exact. The shortest way out is along one of
/// the 15 axes that are normal to a face of either or to an edge of both.
/// source Gottschalk, Lin, Manocha 1996 (separating axes)
CoreDistance BoxOverlap(const CorePair& pair);

}  // namespace oca::geometry::internal
