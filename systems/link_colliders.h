// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "models/robot/link_colliders.h"

namespace oca::systems {

using models::DistanceToBody;
using models::DistanceToLink;
using models::LinkCollider;

/// Those links of a model that have solids, in the model's order. throws ConfigError
std::vector<LinkCollider> MakeLinkColliders(const models::RobotModel& model);

}  // namespace oca::systems
