// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Replaces each cylinder that has a sphere of its own radius centred at either end of its axis
/// (all within 1e-9 m) by the one capsule that fills the same space. URDF has no capsule, and its
/// distances are exact and fast. A sphere may end several cylinders.
std::vector<CollisionElement> FuseCapsules(std::vector<CollisionElement> elements);

}  // namespace oca::robot
