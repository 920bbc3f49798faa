// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Direction (unit, frame of A) along which Bullet's penetration solver finds the shortest way out
/// of an overlap: the origin leaves A - B soonest that way. Zero if it finds none.
///
/// Bullet answers from several first guesses; each answer counts for what the support function says
/// of it, so a wrong depth or a flipped normal does no harm.
Eigen::Vector3d BulletExit(const CorePair& pair);

}  // namespace oca::geometry::internal
