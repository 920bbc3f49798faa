// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/models/robot/link_colliders.h"

namespace oca::systems {

using robot::DistanceToBody;
using robot::DistanceToLink;
using robot::LinkCollider;

/// Those links of a model that have solids, in the model's order. throws ConfigError
std::vector<LinkCollider> MakeLinkColliders(const robot::RobotModel& model);

}  // namespace oca::systems
