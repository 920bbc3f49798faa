// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Finds the signed core distance where algebra gives it, with the simpler core second: a point and
/// anything but a hull, a segment and a segment or box, or a cylinder apart from it, a half-space
/// and anything that ends. False for other pairs.
bool ClosedForm(const CorePair& pair, CoreDistance* found);

/// The same for two cores that are known to overlap or touch: two boxes, a point in a hull.
bool ClosedOverlap(const CorePair& pair, CoreDistance* found);

}  // namespace oca::geometry::internal
