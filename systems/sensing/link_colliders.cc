// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/link_colliders.h"

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"

namespace oca::systems {

std::vector<LinkCollider> MakeLinkColliders(const robot::RobotModel& model) {
  try {
    return robot::LinkCollidersOf(model);
  } catch (const models::ModelError& error) {
    throw ConfigError(error.what());
  }
}

}  // namespace oca::systems
