// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/velocity_aware_law.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace oca::robot {
namespace velocity_aware_law_test {

using Eigen::Vector3d;

constexpr VelocityAwareLaw kUsual{0.1, 2.0, 0.6, 0.01};

// Head on, U = lambda |v| s and F = lambda |v| (1/p^2 - 1/rho0^2) = 1/0.09 - 1/0.36.
TEST(VelocityAwareLawTest, BrakesAHeadOnApproachAsByHand) {
  const VelocityAwareLaw law{1.0, 2.0, 0.6, 0.01};
  const Vector3d force = law.Force(0.3, Vector3d::UnitX(), {-1.0, 0.0, 0.0});
  EXPECT_NEAR((force - Vector3d(1.0 / 0.09 - 1.0 / 0.36, 0.0, 0.0)).norm(), 0.0, 1e-12);
}

// At 60 degrees off the normal: c = -1/2, F_n = (1/4) 25/3, F_t = 2 (1/2) s/p sin 60.
TEST(VelocityAwareLawTest, LeadsAroundWhatItPassesAslant) {
  const VelocityAwareLaw law{1.0, 2.0, 0.6, 0.01};
  const Vector3d v(-0.5, std::sqrt(0.75), 0.0);
  const Vector3d force = law.Force(0.3, Vector3d::UnitX(), v);
  EXPECT_NEAR(force.x(), 0.25 * (1.0 / 0.09 - 1.0 / 0.36), 1e-12);
  EXPECT_NEAR(force.y(), 0.25 / 0.3 / 0.3 * std::sqrt(0.75), 1e-12);
  EXPECT_EQ(force.z(), 0.0);
}

TEST(VelocityAwareLawTest, IsTheNegativeGradientOfItsPotential) {
  const VelocityAwareLaw law{0.7, 2.5, 0.5, 0.01};
  const auto potential = [&](const Vector3d& x, const Vector3d& v) {
    const double p = x.norm();
    const double y = -v.dot(x) / (p * v.norm());
    if (p >= law.range || y <= 0.0) return 0.0;
    const double s = (1.0 - p / law.range) * (1.0 - p / law.range) / p;
    return law.gain * v.norm() * std::pow(y, law.exponent) * s;
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int felt = 0;
  for (int sample = 0; sample < 200; ++sample) {
    const Vector3d x = 0.3 * Vector3d(uniform(random), uniform(random), uniform(random));
    const Vector3d v(uniform(random), uniform(random), uniform(random));
    if (x.norm() < 0.05) continue;
    Vector3d gradient;
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = kStep * Vector3d::Unit(i);
      gradient[i] = (potential(x + d, v) - potential(x - d, v)) / (2.0 * kStep);
    }
    const Vector3d force = law.Force(x.norm(), x.normalized(), v);
    EXPECT_NEAR((force + gradient).norm(), 0.0, 1e-5 * (1.0 + force.norm()));
    felt += force.norm() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(felt, 50);
}

TEST(VelocityAwareLawTest, IsZeroAtRestMovingAwayAndFromTheRimOutwards) {
  const Vector3d n = Vector3d::UnitX();
  EXPECT_EQ(kUsual.Force(0.3, n, Vector3d::Zero()).norm(), 0.0);
  EXPECT_EQ(kUsual.Force(0.3, n, {0.0, 1.0, 0.0}).norm(), 0.0);
  EXPECT_EQ(kUsual.Force(0.3, n, {1.0, 0.0, 0.0}).norm(), 0.0);
  EXPECT_EQ(kUsual.Force(0.6, n, {-1.0, 0.0, 0.0}).norm(), 0.0);
  const double inside = kUsual.Force(0.6 - 1e-6, n, {-1.0, 1.0, 0.0}).norm();
  EXPECT_GT(inside, 0.0);
  EXPECT_LT(inside, 1e-4);
}

TEST(VelocityAwareLawTest, ChangesLittleWhereTheVelocityDoes) {
  const Vector3d n = Vector3d::UnitX();
  for (const Vector3d& v : {Vector3d(-1e-9, 1.0, 0.0), Vector3d(-1e-9, 0.0, 0.0)}) {
    EXPECT_LT(kUsual.Force(0.05, n, v).norm(), 1e-5);  // next to nothing, as at rest or in passing
  }
}

TEST(VelocityAwareLawTest, StaysFiniteAndOutwardAtContactAndInDeepPenetration) {
  const Vector3d n(0.0, 0.6, -0.8);
  const Vector3d v(0.3, -0.5, 0.2);
  const Vector3d floor = kUsual.Force(0.01, n, v);
  for (const double distance : {0.0, -1e-9, -0.1, -1.0}) {
    const Vector3d force = kUsual.Force(distance, n, v);
    EXPECT_EQ(force, floor);
    EXPECT_GT(force.dot(n), 0.0);
  }
}

TEST(VelocityAwareLawTest, MovingTheWorldMovesTheForceAndAMirrorMirrorsIt) {
  const Vector3d n = Vector3d(1.0, 2.0, -1.0).normalized();
  const Vector3d v(-0.6, 0.1, 0.7);
  const Vector3d force = kUsual.Force(0.2, n, v);
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized().toRotationMatrix();
  EXPECT_NEAR((kUsual.Force(0.2, R * n, R * v) - R * force).norm(), 0.0, 1e-12);
  const Eigen::Matrix3d M = Vector3d(1.0, -1.0, 1.0).asDiagonal();
  EXPECT_NEAR((kUsual.Force(0.2, M * n, M * v) - M * force).norm(), 0.0, 1e-12);
}

TEST(VelocityAwareLawTest, SlopesAreTheDerivativesOfTheForceOrMore) {
  const Vector3d n(0.6, 0.0, 0.8);
  const Vector3d v(-0.5, 0.4, -0.1);
  constexpr double kStep = 1e-6;
  const Vector3d by_distance =
      (kUsual.Force(0.25 - kStep, n, v) - kUsual.Force(0.25 + kStep, n, v)) / (2.0 * kStep);
  EXPECT_NEAR((kUsual.Slope(0.25, n, v) - by_distance).norm(), 0.0, 1e-6 * by_distance.norm());
  double worst = 0.0;
  for (double along = -1.0; along < 0.0; along += 0.05) {
    const Vector3d u = Vector3d(0.0, 0.3, 0.0) + along * n;
    const double by_rate =
        n.dot(kUsual.Force(0.25, n, u - kStep * n) - kUsual.Force(0.25, n, u + kStep * n)) /
        (2.0 * kStep);
    EXPECT_LE(by_rate, kUsual.Damping(0.25) * (1.0 + 1e-6)) << along;
    worst = std::max(worst, by_rate);
  }
  EXPECT_GT(worst, 0.95 * kUsual.Damping(0.25)) << "and no more than that";
}

TEST(VelocityAwareLawTest, SlopesAreZeroWhereTheForceIs) {
  const Vector3d n = Vector3d::UnitX();
  EXPECT_EQ(kUsual.Slope(0.3, n, {0.5, 0.1, 0.0}).norm(), 0.0);
  EXPECT_EQ(kUsual.Slope(0.6, n, {-0.5, 0.1, 0.0}).norm(), 0.0);
  EXPECT_EQ(kUsual.Damping(0.6), 0.0);
  EXPECT_GT(kUsual.Damping(0.5999), 0.0);
}

}  // namespace velocity_aware_law_test
}  // namespace oca::robot
