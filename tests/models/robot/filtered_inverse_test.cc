// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/filtered_inverse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/models/robot/saturated_task.h"

namespace oca::robot {
namespace filtered_inverse_test {

TEST(FilteredInverseTest, IsExactAboveTheThresholdAndDampedBelowByHand) {
  // sigma 2 and 0.05: lambda^2 of the second is 0.01 (1 - 0.25).
  const JointMatrix M = Eigen::Vector2d(4.0, 0.0025).asDiagonal();
  const JointVector x = SolveFiltered(M, Eigen::Vector2d(2.0, 1.0), {0.1, 0.1});
  EXPECT_NEAR(x[0], 0.5, 1e-15);
  EXPECT_NEAR(x[1], 1.0 / (0.0025 + 0.0075), 1e-12);
}

TEST(FilteredInverseTest, NoDirectionGainsMoreThanTheDampingAllows) {
  for (const Damping damping : {Damping{0.05, 0.1}, Damping{0.1, 0.1}, Damping{0.08, 0.1}}) {
    for (double sigma = 0.0; sigma < 0.3; sigma += 1e-3) {
      const JointMatrix M = JointMatrix::Constant(1, 1, sigma * sigma);
      const JointVector b = JointVector::Constant(1, sigma);
      EXPECT_LE(SolveFiltered(M, b, damping)[0], 1.0 / damping.most + 1e-12);
    }
  }
}

TEST(FilteredInverseTest, AMatrixOfZerosAsksForNothing) {
  const JointMatrix zero = JointMatrix::Zero(3, 3);
  EXPECT_EQ(SolveFiltered(zero, JointVector::Zero(3), {0.1, 0.1}), Eigen::Vector3d::Zero());
  EXPECT_EQ(SolveFiltered(zero, JointVector::Ones(3), {0.0, 0.1}), Eigen::Vector3d::Zero());
  EXPECT_NEAR((FilteredNullspace(zero, {0.1, 0.1}) - JointMatrix::Identity(3, 3)).norm(), 0.0,
              1e-15);
}

TEST(FilteredInverseTest, TheNullspaceLeavesTheTaskAlone) {
  const Eigen::RowVector3d J(0.9, 0.4, -0.2);
  const JointMatrix N = FilteredNullspace(J.transpose() * J, {0.1, 0.1});
  EXPECT_NEAR((J * N).norm(), 0.0, 1e-15);
  EXPECT_NEAR((N * N - N).norm(), 0.0, 1e-15);
  EXPECT_NEAR(N.trace(), 2.0, 1e-14);
}

TEST(FilteredInverseTest, FadesSmoothlyBetweenItsEnds) {
  EXPECT_EQ(Fade(0.1, 0.1, 0.3), 1.0);
  EXPECT_EQ(Fade(-5.0, 0.1, 0.3), 1.0);
  EXPECT_EQ(Fade(0.3, 0.1, 0.3), 0.0);
  EXPECT_NEAR(Fade(0.2, 0.1, 0.3), 0.5, 1e-15);
  EXPECT_NEAR(Fade(0.25, 0.1, 0.3), 0.15625, 1e-15);
  EXPECT_EQ(Fade(std::nan(""), 0.1, 0.3), 0.0);
}

JointVector Saturated(const Eigen::Vector2d& wish, double xdot, double upper_1) {
  const Eigen::RowVector2d J(0.9, 0.4);
  return SaturateInNullspace(J.transpose() * J, J.transpose() * xdot, wish, Eigen::Vector2d(-2, -2),
                             Eigen::Vector2d(upper_1, 2), {0.01, 0.01});
}

TEST(SaturatedTaskTest, WithinTheBoundsItIsTheNearestToTheWish) {
  const JointVector u = Saturated({0.1, 0.2}, 0.17 + 0.97 * 0.5, 2.0);
  EXPECT_NEAR((u - Eigen::Vector2d(0.1 + 0.45, 0.2 + 0.2)).norm(), 0.0, 1e-12);
}

TEST(SaturatedTaskTest, TheOthersTakeOverWhatABoundTakes) {
  const JointVector u = Saturated({0, 0}, 0.5, 0.2);
  EXPECT_NEAR((u - Eigen::Vector2d(0.2, (0.5 - 0.18) / 0.4)).norm(), 0.0, 1e-12);
}

TEST(SaturatedTaskTest, WhatNobodyCanTakeIsLeft) {
  EXPECT_NEAR((Saturated({0, 0}, 5.0, 0.2) - Eigen::Vector2d(0.2, 2.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((Saturated({0, 0}, 0.3, -2.0) - Eigen::Vector2d(-2.0, 2.0)).norm(), 0.0, 1e-12);
}

TEST(SaturatedTaskTest, WithoutATaskItClipsTheWish) {
  const JointMatrix none = JointMatrix::Zero(2, 2);
  const JointVector u =
      SaturateInNullspace(none, JointVector::Zero(2), Eigen::Vector2d(5, -0.5),
                          Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1), {0.1, 0.1});
  EXPECT_EQ(u, Eigen::Vector2d(1, -0.5));
}

}  // namespace filtered_inverse_test
}  // namespace oca::robot
