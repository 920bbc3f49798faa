// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace oca::motion {
namespace trajectory_test {

using Eigen::Vector2d;

/// Two joints, uneven times, velocities and accelerations everywhere.
std::vector<KeyPoint> FullPoints() {
  return {{0.5, Vector2d(0.0, 1.0), Vector2d(0.3, -0.2), Vector2d(0.1, 0.4)},
          {1.0, Vector2d(1.0, -1.0), Vector2d(-0.5, 0.7), Vector2d(-0.6, 0.2)},
          {2.5, Vector2d(0.5, 2.0), Vector2d(0.9, 0.1), Vector2d(0.3, -0.8)},
          {3.0, Vector2d(-0.5, 2.5), Vector2d(0.0, -0.4), Vector2d(0.5, 0.6)}};
}

std::vector<KeyPoint> Bare(std::vector<KeyPoint> points) {
  for (KeyPoint& point : points) point.velocity = point.acceleration = std::nullopt;
  return points;
}

/// A derivative just before and just after `time`.
double Jump(const Trajectory& trajectory, double time, int derivative) {
  constexpr double kClose = 1e-9;  // s
  return (trajectory.Evaluate(time + kClose, derivative) -
          trajectory.Evaluate(time - kClose, derivative))
      .norm();
}

void ExpectDerivativesAgreeWithDifferences(const Trajectory& trajectory, int derivatives) {
  constexpr double kStep = 1e-5;  // s
  for (double t = 0.51; t < 3.0; t += 0.073) {
    for (int derivative = 1; derivative <= derivatives; ++derivative) {
      const Eigen::VectorXd difference = (trajectory.Evaluate(t + kStep, derivative - 1) -
                                          trajectory.Evaluate(t - kStep, derivative - 1)) /
                                         (2.0 * kStep);
      EXPECT_LT((difference - trajectory.Evaluate(t, derivative)).norm(), 1e-6)
          << t << " " << derivative;
    }
  }
}

TEST(TrajectoryTest, CubicFromRestToRestIsTheKnownPolynomial) {
  // 3 s^2 - 2 s^3 over 2 s, from 0 to 1: at s = 1/4 5/32, rate 9/16, at the start 6 / 4.
  const auto cubic =
      Trajectory::CubicHermite({{.time = 1.0, .position = Eigen::VectorXd::Zero(1)},
                                {.time = 3.0, .position = Eigen::VectorXd::Ones(1)}});
  EXPECT_DOUBLE_EQ(cubic.Evaluate(1.5, 0)[0], 5.0 / 32.0);
  EXPECT_DOUBLE_EQ(cubic.Evaluate(1.5, 1)[0], 9.0 / 16.0);
  EXPECT_DOUBLE_EQ(cubic.Evaluate(1.0, 2)[0], 1.5);
  EXPECT_DOUBLE_EQ(cubic.Evaluate(3.0, 2)[0], -1.5);
}

TEST(TrajectoryTest, QuinticFromRestToRestIsTheKnownPolynomial) {
  // 10 s^3 - 15 s^4 + 6 s^5 over 2 s: at s = 1/4 53/512; largest rate 15/8 / 2 at s = 1/2.
  const auto quintic =
      Trajectory::QuinticHermite({{.time = 0.0, .position = Eigen::VectorXd::Zero(1)},
                                  {.time = 2.0, .position = Eigen::VectorXd::Ones(1)}});
  EXPECT_DOUBLE_EQ(quintic.Evaluate(0.5, 0)[0], 53.0 / 512.0);
  EXPECT_DOUBLE_EQ(quintic.Evaluate(1.0, 1)[0], 15.0 / 16.0);
  EXPECT_NEAR(quintic.Evaluate(1.0, 2)[0], 0.0, 1e-14);
}

TEST(TrajectoryTest, NaturalSplineThroughThreePointsIsTheOneComputedByHand) {
  // Through (0,0), (1,1), (2,0): second derivative -3 at the middle, velocities 3/2, 0, -3/2.
  std::vector<KeyPoint> points(3);
  for (int i = 0; i < 3; ++i) {
    points[i] = {.time = double(i), .position = Eigen::VectorXd::Constant(1, i % 2)};
  }
  const auto spline = Trajectory::CubicSpline(points, Trajectory::Ends::kNatural);
  EXPECT_DOUBLE_EQ(spline.Evaluate(0.0, 1)[0], 1.5);
  EXPECT_DOUBLE_EQ(spline.Evaluate(0.5, 0)[0], 11.0 / 16.0);
  EXPECT_DOUBLE_EQ(spline.Evaluate(1.0, 2)[0], -3.0);
  EXPECT_NEAR(spline.Evaluate(2.0, 2)[0], 0.0, 1e-14);
}

TEST(TrajectoryTest, ClampedSplineReproducesACubic) {
  const auto p = [](double t) { return t * t * t - 2.0 * t * t + 0.5 * t + 1.0; };
  const auto v = [](double t) { return 3.0 * t * t - 4.0 * t + 0.5; };
  std::vector<KeyPoint> points;
  for (const double t : {-1.0, 0.2, 0.5, 2.0, 3.0}) {
    points.push_back({.time = t, .position = Eigen::VectorXd::Constant(1, p(t))});
  }
  points.front().velocity = Eigen::VectorXd::Constant(1, v(-1.0));
  points.back().velocity = Eigen::VectorXd::Constant(1, v(3.0));
  const auto spline = Trajectory::CubicSpline(points, Trajectory::Ends::kClamped);
  for (double t = -1.0; t <= 3.0; t += 0.1) {
    EXPECT_NEAR(spline.Evaluate(t, 0)[0], p(t), 1e-13) << t;
    EXPECT_NEAR(spline.Evaluate(t, 1)[0], v(t), 1e-13) << t;
  }
}

TEST(TrajectoryTest, EveryKindPassesItsPointsWithWhatItPromises) {
  const auto points = FullPoints();
  const auto linear = Trajectory::Linear(points);
  const auto cubic = Trajectory::CubicHermite(points);
  const auto quintic = Trajectory::QuinticHermite(points);
  const auto spline = Trajectory::CubicSpline(Bare(points), Trajectory::Ends::kClamped);
  for (const KeyPoint& point : points) {
    for (const Trajectory* any : {&linear, &cubic, &quintic, &spline}) {
      EXPECT_LT((any->Evaluate(point.time, 0) - point.position).norm(), 1e-14);
    }
    EXPECT_LT((cubic.Evaluate(point.time, 1) - *point.velocity).norm(), 1e-13);
    EXPECT_LT((quintic.Evaluate(point.time, 1) - *point.velocity).norm(), 1e-13);
    EXPECT_LT((quintic.Evaluate(point.time, 2) - *point.acceleration).norm(), 1e-12);
  }
}

TEST(TrajectoryTest, PromisedDerivativesAreContinuousAtTheKnotsAndTheNextIsNot) {
  const auto points = FullPoints();
  const auto natural = Trajectory::CubicSpline(Bare(points), Trajectory::Ends::kNatural);
  const auto clamped = Trajectory::CubicSpline(Bare(points), Trajectory::Ends::kClamped);
  const auto cubic = Trajectory::CubicHermite(points);
  const auto quintic = Trajectory::QuinticHermite(points);
  for (const double knot : {1.0, 2.5}) {
    EXPECT_LT(Jump(cubic, knot, 1), 1e-6);
    EXPECT_GT(Jump(cubic, knot, 2), 0.1);
    for (const Trajectory* c2 : {&natural, &clamped, &quintic}) {
      EXPECT_LT(Jump(*c2, knot, 1), 1e-6);
      EXPECT_LT(Jump(*c2, knot, 2), 1e-5);
      EXPECT_GT(Jump(*c2, knot, 3), 0.1);
    }
  }
}

TEST(TrajectoryTest, DerivativesAgreeWithDifferences) {
  const auto points = FullPoints();
  ExpectDerivativesAgreeWithDifferences(Trajectory::QuinticHermite(points), 4);
  // The acceleration of the other two jumps or bends at the knots, which a difference smears.
  ExpectDerivativesAgreeWithDifferences(Trajectory::CubicHermite(points), 1);
  ExpectDerivativesAgreeWithDifferences(
      Trajectory::CubicSpline(Bare(points), Trajectory::Ends::kNatural), 2);
}

TEST(TrajectoryTest, HoldsTheEndsWithoutRates) {
  const auto quintic = Trajectory::QuinticHermite(FullPoints());
  for (const double outside : {0.4999, 3.0001}) {
    EXPECT_EQ(quintic.Evaluate(outside, 1).norm(), 0.0);
    EXPECT_EQ(quintic.Evaluate(outside, 2).norm(), 0.0);
  }
  EXPECT_EQ(Vector2d(quintic.Evaluate(-7.0, 0)), Vector2d(0.0, 1.0));
  EXPECT_EQ(Vector2d(quintic.Evaluate(99.0, 0)), Vector2d(-0.5, 2.5));
  EXPECT_EQ(Vector2d(quintic.Evaluate(3.0, 0)), Vector2d(-0.5, 2.5));
}

TEST(TrajectoryTest, ASinglePointRestsForEver) {
  const std::vector<KeyPoint> one{{.time = 1.0, .position = Vector2d(2.0, 3.0)}};
  for (const auto& rest :
       {Trajectory::Linear(one), Trajectory::CubicHermite(one), Trajectory::QuinticHermite(one),
        Trajectory::CubicSpline(one, Trajectory::Ends::kNatural)}) {
    for (const double t : {0.0, 1.0, 2.0}) {
      EXPECT_EQ(Vector2d(rest.Evaluate(t, 0)), Vector2d(2.0, 3.0));
      EXPECT_EQ(rest.Evaluate(t, 1).norm(), 0.0);
    }
  }
}

TEST(TrajectoryTest, LinesTakeTheRateOfTheLaterSegmentAtAKnot) {
  const auto linear = Trajectory::Linear(FullPoints());
  EXPECT_EQ(Vector2d(linear.Evaluate(0.75, 0)), Vector2d(0.5, 0.0));
  EXPECT_EQ(Vector2d(linear.Evaluate(1.0, 1)), Vector2d(-0.5 / 1.5, 2.0));
  EXPECT_EQ(linear.Evaluate(0.75, 2).norm(), 0.0);
}

}  // namespace trajectory_test
}  // namespace oca::motion
