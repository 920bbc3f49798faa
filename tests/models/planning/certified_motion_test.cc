// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/certified_motion.h"

#include <gtest/gtest.h>

#include "oca/models/random.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace certified_motion_test {

using test::Arm;
using test::BoxAt;

TEST(CertifiedMotionTest, SeesAThinPlateBetweenTwoClearPositions) {
  // 1 mm thick: samples half a radian apart would step over it.
  robot::Clearance clearance(Arm("planar2"), false, {BoxAt({0.4, 0.001, 0.4}, {0.7, 0.0, 0.0})});
  CertifiedMotion motion(clearance, 0.001);
  const Eigen::Vector2d below(-0.5, 0.0);
  const Eigen::Vector2d above(0.5, 0.0);
  EXPECT_TRUE(motion.Clear(below));
  EXPECT_TRUE(motion.Clear(above));
  EXPECT_FALSE(motion.Clear(below, above));
  const double share = motion.ClearShare(below, above);
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 0.5);
}

TEST(CertifiedMotionTest, HoldsTheMarginFromBothSides) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  const Eigen::Vector2d from(0.0, 0.0);
  const Eigen::Vector2d to(0.5, 0.0);
  double least = 1.0;  // over the motion, finely sampled
  for (int i = 0; i <= 10000; ++i) {
    clearance.MoveTo(from + i * 1e-4 * (to - from));
    least = std::min(least, clearance.Nearest().distance);
  }
  ASSERT_GT(least, 0.01);
  EXPECT_TRUE(CertifiedMotion(clearance, least - 2e-3).Clear(from, to));
  EXPECT_FALSE(CertifiedMotion(clearance, least + 1e-6).Clear(from, to));
}

TEST(CertifiedMotionTest, CallsNoMotionClearThatSamplesShowIsNot) {
  robot::Clearance clearance(
      Arm("lwr4"), true,
      {BoxAt({0.1, 0.2, 0.3}, {0.4, 0.2, 0.6}), BoxAt({0.2, 0.2, 0.2}, {-0.4, 0, 0.7})});
  constexpr double kMargin = 0.01;
  CertifiedMotion motion(clearance, kMargin);
  models::Random random(11);
  int clear = 0;
  int blocked = 0;
  for (int i = 0; i < 500; ++i) {
    Eigen::VectorXd from(7);
    Eigen::VectorXd to(7);
    for (int j = 0; j < 7; ++j) {
      from[j] = random.Uniform(-2.0, 2.0);
      to[j] = from[j] + random.Uniform(-0.7, 0.7);
    }
    const double share = motion.ClearShare(from, to);
    (share == 1.0 ? clear : blocked) += 1;
    for (int k = 0; k <= 100; ++k) {
      clearance.MoveTo(from + share * k * 0.01 * (to - from));
      EXPECT_TRUE(share == 0.0 || clearance.Nearest().distance > kMargin - 1e-9);
    }
  }
  EXPECT_GT(clear, 50);
  EXPECT_GT(blocked, 50);
}

TEST(CertifiedMotionTest, OfAMotionThatRestsAsksForItsPositionOnly) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  CertifiedMotion motion(clearance, 0.01);
  EXPECT_TRUE(motion.Clear(Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()));
}

}  // namespace certified_motion_test
}  // namespace oca::planning
