// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ball_cover.h"

#include <gtest/gtest.h>

#include "oca/models/geometry/distance.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace ball_cover_test {

bool Contains(const std::vector<Ball>& balls, const Eigen::Vector3d& point) {
  for (const Ball& ball : balls) {
    if ((point - ball.centre).norm() <= ball.radius + 1e-9) return true;
  }
  return false;
}

/// The farthest point of a solid in a random direction, drawn towards another such point: all of a
/// convex solid may come.
Eigen::Vector3d PointOf(const Collider& solid, RandomBodies& random) {
  const auto farthest = [&](const Eigen::Vector3d& direction) -> Eigen::Vector3d {
    return solid.Support(direction) + solid.radius() * direction;
  };
  const Eigen::Vector3d a = farthest(random.Direction());
  return a + random.Uniform(0.0, 1.0) * (farthest(random.Direction()) - a);
}

TEST(BallCoverTest, ContainsEveryPointOfASolid) {
  RandomBodies random(7);
  for (int i = 0; i < 70; ++i) {
    const auto solid = MakeCollider(random.RandomShape(i % RandomBodies::kKinds), "solid");
    const int most = 1 + random.Integer(16);
    const auto balls = CoverWithBalls(*solid, most, 0.002);
    EXPECT_LE(std::ssize(balls), std::max(most, 2));
    for (int p = 0; p < 500; ++p) {
      ASSERT_TRUE(Contains(balls, PointOf(*solid, random))) << "solid " << i << ", " << most;
    }
  }
}

TEST(BallCoverTest, ASphereIsItself) {
  const auto balls = CoverWithBalls(*MakeCollider(Sphere{0.3}, "ball"), 8, 0.01);
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_EQ(balls[0].radius, 0.3);
}

TEST(BallCoverTest, BallsOfACapsuleStickOutByTheSlackAtMost) {
  // Balls 2 d apart stick out by hypot(0.1, d) - 0.1: 0.005 m at d = 0.032.
  const auto solid = MakeCollider(Capsule{0.1, 0.5}, "capsule");
  const auto enough = CoverWithBalls(*solid, 100, 0.005);
  EXPECT_EQ(enough.size(), 9u);
  for (const Ball& ball : enough) EXPECT_LE(ball.radius, 0.105);
  const auto few = CoverWithBalls(*solid, 3, 0.005);
  ASSERT_EQ(few.size(), 3u);
  EXPECT_DOUBLE_EQ(few[0].radius, std::hypot(0.1, 0.125));
}

TEST(BallCoverTest, MoreBallsStickOutLess) {
  const auto rod = MakeCollider(Box{{0.1, 0.1, 0.8}}, "rod");
  double before = 1.0;
  for (const int most : {1, 2, 4, 8}) {
    const auto balls = CoverWithBalls(*rod, most, 0.0);
    ASSERT_EQ(std::ssize(balls), most);
    double largest = 0.0;
    for (const Ball& ball : balls) largest = std::max(largest, ball.radius);
    EXPECT_LT(largest, before);
    before = largest;
  }
  EXPECT_NEAR(before, 0.5 * std::sqrt(0.03), 0.001);  // cubes of 0.1 m
}

TEST(BallCoverTest, OfACompoundEachPartIsCoveredWhereItIs) {
  Compound two;
  for (const double x : {-1.0, 1.0}) {
    CompoundPart part{Eigen::Isometry3d::Identity(), Sphere{0.1}};
    part.X_SP.translation().x() = x;
    two.parts.push_back(part);
  }
  const auto balls = CoverWithBalls(*MakeCollider(two, "two"), 4, 0.01);
  ASSERT_EQ(balls.size(), 2u);
  EXPECT_EQ(balls[1].centre, Eigen::Vector3d(1.0, 0.0, 0.0));
}

TEST(BallCoverTest, AHalfSpaceHasNone) {
  EXPECT_TRUE(CoverWithBalls(*MakeCollider(HalfSpace{}, "floor"), 4, 0.01).empty());
}

TEST(InnerRadiusTest, IsWhatFitsAboutAPoint) {
  const auto of = [](const Shape& shape, const Eigen::Vector3d& p) {
    return InnerRadius(*MakeCollider(shape, "solid"), p);
  };
  EXPECT_NEAR(of(Sphere{0.3}, {0.1, 0.0, 0.0}), 0.2, 1e-12);
  EXPECT_NEAR(of(Capsule{0.1, 0.4}, {0.0, 0.03, 0.1}), 0.07, 1e-12);
  EXPECT_NEAR(of(Capsule{0.1, 0.4}, {0.0, 0.0, 0.25}), 0.05, 1e-12);
  EXPECT_NEAR(of(Box{{0.2, 0.4, 0.6}}, {0.0, 0.15, 0.0}), 0.05, 1e-12);
  EXPECT_NEAR(of(Cylinder{0.1, 0.4}, {0.06, 0.0, 0.15}), 0.04, 1e-12);
  EXPECT_EQ(of(Box{{0.2, 0.4, 0.6}}, {0.0, 0.25, 0.0}), 0.0) << "outside";
  RandomBodies random(3);
  const auto hull = MakeCollider(random.RandomShape(4), "hull");
  const auto ball = MakeCollider(Sphere{1e-3}, "ball");
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = hull->centre();
  const double depth = Distance(*ball, X, *hull, Eigen::Isometry3d::Identity()).distance + 1e-3;
  EXPECT_NEAR(InnerRadius(*hull, hull->centre()), std::max(-depth, 0.0), 1e-9);
}

TEST(EnclosingBallTest, IsNearlyTheSmallest) {
  std::vector<Eigen::Vector3d> points;
  for (int corner = 0; corner < 8; ++corner) {
    points.emplace_back(corner & 1, (corner >> 1) & 1, corner >> 2);
  }
  const Ball ball = EnclosingBall(points);
  EXPECT_NEAR(ball.radius, std::sqrt(0.75), 0.01);
  for (const auto& point : points) EXPECT_LE((point - ball.centre).norm(), ball.radius);
  EXPECT_EQ(EnclosingBall({Eigen::Vector3d::UnitX()}).radius, 0.0);
}

}  // namespace ball_cover_test
}  // namespace oca::geometry
