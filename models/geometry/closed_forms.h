// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "models/geometry/core_pair.h"

namespace oca::models::internal {

/// Signed core distance where algebra gives it: B a point and A a point, segment, box or cylinder,
/// or two segments. Nothing for other pairs.
///
/// Where the direction is not unique (a point in the middle of a box, coincident centres, crossing
/// axes) one of the shortest is taken, always the same one.
/// source Ericson 2005, chapter 5
std::optional<CoreDistance> ClosedForm(const CorePair& pair);

}  // namespace oca::models::internal
