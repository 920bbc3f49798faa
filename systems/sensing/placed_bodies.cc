// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/placed_bodies.h"

namespace oca::systems {

std::vector<robot::PlacedBody> PlacedBodies(const ObstacleSet& set) {
  std::vector<robot::PlacedBody> bodies;
  bodies.reserve(set.obstacles.size());
  for (const Obstacle& obstacle : set.obstacles) {
    bodies.push_back({obstacle.body->collider, obstacle.X_WO});
  }
  return bodies;
}

}  // namespace oca::systems
