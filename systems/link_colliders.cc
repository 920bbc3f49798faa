// SPDX-License-Identifier: BSD-3-Clause
#include "systems/link_colliders.h"

#include "framework/error.h"
#include "models/error.h"

namespace oca::systems {

std::vector<LinkCollider> MakeLinkColliders(const models::RobotModel& model) {
  try {
    return models::LinkCollidersOf(model);
  } catch (const models::ModelError& error) {
    throw ConfigError(error.what());
  }
}

}  // namespace oca::systems
