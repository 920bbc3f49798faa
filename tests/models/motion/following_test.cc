// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/following.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace oca::motion {
namespace following_test {

constexpr double kDt = 0.01;

TEST(FollowingVelocityTest, AddsTheRequestsOwnMotionToTheWayBack) {
  // 5 (1.02 - 1) + 0.3 + 2 / 2 * 0.01, far from what the acceleration limit bounds
  EXPECT_DOUBLE_EQ(FollowingVelocity({1.02, 0.3, 2.0}, 1.0, 5.0, 1e3, kDt), 0.41);
  EXPECT_DOUBLE_EQ(FollowingVelocity({0.98, 0.3, 2.0}, 1.0, 5.0, 1e3, kDt), 0.21);
  EXPECT_DOUBLE_EQ(FollowingVelocity({1.0, 0.3, 2.0}, 1.0, 5.0, 10.0, kDt), 0.31);
}

TEST(FollowingVelocityTest, HalfTheAccelerationLimitStopsAtTheRequestAndNoLess) {
  const double limit = 10.0;
  double position = 0.0;
  double last = FollowingVelocity({2.0, 0.0, 0.0}, position, 1.0 / kDt, limit, kDt);
  for (int k = 0; k < 500; ++k) {
    position += last * kDt;
    EXPECT_LE(position, 2.0 + 1e-12);
    const double next = FollowingVelocity({2.0, 0.0, 0.0}, position, 1.0 / kDt, limit, kDt);
    EXPECT_GE(next - last, -0.5 * limit * kDt - 1e-9);
    last = next;
  }
  EXPECT_NEAR(position, 2.0, 1e-9);
}

TEST(FollowingVelocityTest, WithoutAnAccelerationLimitOnlyTheGainCounts) {
  const double unlimited = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(FollowingVelocity({3.0, 0.0, 0.0}, 1.0, 5.0, unlimited, kDt), 10.0);
}

}  // namespace following_test
}  // namespace oca::motion
