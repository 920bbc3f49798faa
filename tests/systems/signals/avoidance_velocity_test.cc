// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/avoidance_velocity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace avoidance_velocity_test {

TEST(AvoidanceVelocityTest, ComesBackFromItsText) {
  AvoidanceVelocity value;
  value.velocity = Eigen::Vector2d(0.1, -1e-17);
  value.share = 0.25;
  value.rows = 3;
  std::string text;
  Signal<AvoidanceVelocity>::WriteJson(value, text);
  const AvoidanceVelocity back = Signal<AvoidanceVelocity>::ReadJson(text);
  EXPECT_EQ(back.velocity, value.velocity);
  EXPECT_EQ(back.share, value.share);
  EXPECT_EQ(back.rows, value.rows);
}

TEST(AvoidanceVelocityTest, RefusesAnUnknownKeyAndTellsNumbersThatAreNone) {
  EXPECT_THROW(Signal<AvoidanceVelocity>::ReadJson(R"({"velocity":[],"share":0,"rows":0,"x":1})"),
               ConfigError);
  AvoidanceVelocity value;
  EXPECT_TRUE(Signal<AvoidanceVelocity>::Check(value, Look::kFinite).ok());
  value.velocity = Eigen::Vector2d(0, std::nan(""));
  EXPECT_FALSE(Signal<AvoidanceVelocity>::Check(value, Look::kFinite).ok());
}

}  // namespace avoidance_velocity_test
}  // namespace oca::systems
