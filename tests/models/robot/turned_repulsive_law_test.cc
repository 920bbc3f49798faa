// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/turned_repulsive_law.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace oca::robot {
namespace turned_repulsive_law_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr RepulsiveLaw kRepulsion{1.0, 0.3, 0.01};

// |F| of eq. (3.1) at 0.2 m is 41.667 N, beyond half of the range it is turned in full.
TEST(TurnedRepulsiveLawTest, TurnsTheForceByItsAngleAboutTheAxis) {
  const TurnedRepulsiveLaw law{kRepulsion, 0.5};
  const Vector3d force = law.Force(0.2, Vector3d::UnitX(), Vector3d::UnitZ());
  const Vector3d expected = 1000.0 / 24.0 * Vector3d(std::cos(0.5), std::sin(0.5), 0.0);
  EXPECT_NEAR((force - expected).norm(), 0.0, 1e-9);
  EXPECT_EQ(law.Angle(0.15), 0.5);
  EXPECT_NEAR(law.Angle(0.075), 0.25, 1e-15);
  EXPECT_EQ(law.Angle(0.0), 0.0);
  EXPECT_EQ(law.Angle(-0.1), 0.0);
}

TEST(TurnedRepulsiveLawTest, IsTheRepulsionIfItDoesNotTurn) {
  const TurnedRepulsiveLaw law{kRepulsion, 0.0};
  const Vector3d n = Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double distance : {0.3, 0.29, 0.1, 0.0, -0.2}) {
    EXPECT_NEAR((law.Force(distance, n, Vector3d::UnitZ()) - kRepulsion.Force(distance) * n).norm(),
                0.0, 1e-12 * kRepulsion.Force(distance));
  }
}

TEST(TurnedRepulsiveLawTest, IsContinuousInTheDistanceAndInTheNormal) {
  const TurnedRepulsiveLaw law{kRepulsion, 1.0};
  const Vector3d n = Vector3d::UnitX(), a = Vector3d::UnitZ();
  const Vector3d tilted = Vector3d(1.0, 1e-7, -2e-7).normalized();
  for (const double distance : {0.299999, 0.15, 0.01, 0.0, -0.05}) {
    const Vector3d force = law.Force(distance, n, a);
    const double size = 1.0 + force.norm();
    EXPECT_LT((law.Force(distance + 1e-7, n, a) - law.Force(distance - 1e-7, n, a)).norm(),
              1e-4 * size);
    EXPECT_LT((law.Force(distance, tilted, a) - force).norm(), 1e-6 * size);
    // A nearest feature that changes turns the normal at once: the force stays as large as it was.
    EXPECT_LE((law.Force(distance, Vector3d::UnitY(), a) - force).norm(), 2.0 * size);
  }
  EXPECT_EQ(law.Force(0.3, n, a).norm(), 0.0);
}

TEST(TurnedRepulsiveLawTest, PointsStraightOutAtContactAndNeverInwards) {
  const TurnedRepulsiveLaw law{kRepulsion, 1.5};
  const Vector3d n(0.0, 0.6, -0.8), a = Vector3d::UnitX();
  for (const double distance : {-1.0, -0.1, -1e-9, 0.0}) {
    const Vector3d force = law.Force(distance, n, a);
    EXPECT_NEAR((force - force.norm() * n).norm(), 0.0, 1e-6);
    EXPECT_TRUE(force.allFinite());
  }
  for (double distance = 0.01; distance < 0.3; distance += 0.01) {
    const Vector3d force = law.Force(distance, n, a);
    EXPECT_GE(force.dot(n), force.norm() * std::cos(1.5) - 1e-9) << distance;
  }
}

TEST(TurnedRepulsiveLawTest, TheSlopeIsTheDerivativeOfTheForce) {
  const TurnedRepulsiveLaw law{kRepulsion, 1.0};
  const Vector3d n = Vector3d(1.0, -0.3, 0.4).normalized();
  const Vector3d a = Vector3d(0.0, 0.4, 0.3).normalized();
  for (const double distance : {0.25, 0.1, 0.03}) {
    constexpr double kStep = 1e-7;
    const Vector3d numeric =
        (law.Force(distance - kStep, n, a) - law.Force(distance + kStep, n, a)) / (2.0 * kStep);
    EXPECT_NEAR((law.Slope(distance, n, a) - numeric).norm(), 0.0, 1e-5 * numeric.norm())
        << distance;
  }
}

TEST(AxisAroundTest, TurnsTheNormalTowardsTheWayAndALittleUp) {
  const Vector3d n = Vector3d::UnitX();
  const Matrix3d R = Matrix3d::Identity();
  const Vector3d axis = AxisAround(n, {0.0, 2.0, 0.0}, R);
  EXPECT_NEAR((axis - Vector3d(0.0, -0.05, 1.0).normalized()).norm(), 0.0, 1e-12);
  EXPECT_GT(axis.cross(n).y(), 0.9);
  EXPECT_LT(AxisAround(n, {0.0, -2.0, 0.0}, R).cross(n).y(), -0.9);
}

TEST(AxisAroundTest, SomeWayIsAlwaysFound) {
  const Matrix3d R = Eigen::AngleAxisd(0.4, Vector3d::UnitY()).toRotationMatrix();
  // Straight at the obstacle, or nowhere: up.
  for (const Vector3d& way : {Vector3d(-R.col(0)), Vector3d(Vector3d::Zero())}) {
    EXPECT_NEAR((AxisAround(R.col(0), way, R).cross(R.col(0)) - R.col(2)).norm(), 0.0, 1e-12);
  }
  // And the normal is up too: towards x.
  EXPECT_NEAR((AxisAround(R.col(2), Vector3d::Zero(), R).cross(R.col(2)) - R.col(0)).norm(), 0.0,
              1e-12);
}

}  // namespace turned_repulsive_law_test
}  // namespace oca::robot
