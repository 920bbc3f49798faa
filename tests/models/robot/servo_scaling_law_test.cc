// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/servo_scaling_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/models/robot/law_scene.h"

namespace oca::robot::test {
namespace servo_scaling_law_test {

constexpr double kHalf = 0.0316227766;  // 1000^-1/2: the law at half the distance

TEST(ServoScalingLawTest, TheLawByHand) {
  constexpr ServoScalingLaw law{0.1, 0.02, false};
  EXPECT_EQ(law.ScaleAt(0.1, false), 1.0);
  EXPECT_NEAR(law.ScaleAt(0.1 - 1e-9, false), 1.0, 1e-6);
  EXPECT_NEAR(law.ScaleAt(0.05, false), kHalf, 1e-9);
  EXPECT_NEAR(law.ScaleAt(1e-12, false), 1e-3, 1e-9);
  EXPECT_EQ(law.ScaleAt(0.0, false), 0.0);
  EXPECT_EQ(law.ScaleAt(-3.0, false), 0.0);
  EXPECT_NEAR(law.ScaleAt(0.01, true), kHalf, 1e-9);
  EXPECT_NEAR(law.ScaleAt(0.002, true, 0.004), kHalf, 1e-9) << "half of what is asked of a pair";
  EXPECT_EQ(law.ScaleAt(0.004, true, 0.004), 1.0);
  EXPECT_NEAR(law.ScaleAt(0.01, true, 0.5), kHalf, 1e-9);
}

TEST(ServoScalingLawTest, TheSlopeOfTheLawIsThatOfItsFormula) {
  constexpr ServoScalingLaw law{0.1, 0.02, false};
  for (const double d : {0.01, 0.05, 0.09}) {
    const double numeric = (law.ScaleAt(d + 1e-7, false) - law.ScaleAt(d - 1e-7, false)) / 2e-7;
    EXPECT_NEAR(numeric, std::log(1000.0) / 0.1 * law.ScaleAt(d, false), 1e-5) << d;
  }
}

TEST(ServoScalingLawTest, OnlyAnApproachIsSlowedIfAsked) {
  const RobotModel model = LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf");
  const auto X_WL = LinkPoses(model, Eigen::Vector2d::Zero());
  const Proximity toward = Above("planar2_link_1", 0.5, 0.05);
  const JointVector up = Eigen::Vector2d(1, 0);  // 0.5 m/s in +y at x = 0.5 m
  const JointVector slow = Eigen::Vector2d(0.02, 0);
  for (const bool approach_only : {false, true}) {
    const ServoScalingLaw law{0.1, 0.02, approach_only};
    EXPECT_NEAR(law.Scale(model, X_WL, toward, up), kHalf, 1e-9);
    // 0.01 m/s is half of what is slowed in full.
    EXPECT_NEAR(law.Scale(model, X_WL, toward, slow), approach_only ? 0.5 + 0.5 * kHalf : kHalf,
                1e-9);
    EXPECT_NEAR(law.Scale(model, X_WL, Mirrored(toward), up), approach_only ? 1.0 : kHalf, 1e-9);
  }
}

}  // namespace servo_scaling_law_test
}  // namespace oca::robot::test
