// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/placed_bodies.h"

#include <gtest/gtest.h>

#include "oca/systems/sensing/geometry_params.h"

namespace oca::systems {
namespace placed_bodies_test {

TEST(PlacedBodiesTest, AreTheSolidsOfObstaclesInTheirOrder) {
  ObstacleSet set;
  for (const char* id : {"one", "other"}) {
    ShapeParams shape;
    shape.radius = 0.1;
    Obstacle& obstacle = set.obstacles.emplace_back();
    obstacle.body = MakeObstacleBody(id, shape, id);
    obstacle.X_WO.translation().x() = static_cast<double>(set.obstacles.size());
  }
  const auto bodies = PlacedBodies(set);
  ASSERT_EQ(bodies.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(bodies[i].collider, set.obstacles[i].body->collider);
    EXPECT_EQ(bodies[i].X_WO.matrix(), set.obstacles[i].X_WO.matrix());
  }
}

}  // namespace placed_bodies_test
}  // namespace oca::systems
