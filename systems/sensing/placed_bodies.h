// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/models/robot/clearance.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// The solids of obstacles where they are, in their order.
std::vector<robot::PlacedBody> PlacedBodies(const ObstacleSet& set);

}  // namespace oca::systems
