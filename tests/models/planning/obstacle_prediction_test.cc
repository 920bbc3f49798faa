// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/obstacle_prediction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace oca::planning {
namespace obstacle_prediction_test {

using Eigen::Vector3d;
using geometry::Obstacle;
using geometry::ObstacleBody;
using geometry::ObstacleEstimate;

Obstacle At(const Vector3d& p, const Vector3d& linear = Vector3d::Zero(),
            const Vector3d& angular = Vector3d::Zero()) {
  static const auto body = std::make_shared<const ObstacleBody>();
  return {body, Eigen::Isometry3d(Eigen::Translation3d(p)), linear, angular};
}

TEST(ObstaclePredictionTest, GoesOnStraightAndTurning) {
  const Obstacle obstacle = At({1, 2, 3}, {0.5, 0, 0}, {0, 0, std::numbers::pi});
  const Eigen::Isometry3d X = Foreseen(obstacle, 0.5);
  EXPECT_TRUE(X.translation().isApprox(Vector3d(1.25, 2, 3)));
  EXPECT_TRUE(X.linear().isApprox(
      Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix()));
  EXPECT_EQ(Foreseen(At({1, 2, 3}), 5.0).matrix(), At({1, 2, 3}).X_WO.matrix());
}

TEST(ObstaclePredictionTest, StandsWhatIsSlowerThanAMillionth) {
  EXPECT_TRUE(Stands(At({0, 0, 0}, {0.9e-6, 0, 0})));
  EXPECT_FALSE(Stands(At({0, 0, 0}, {1.1e-6, 0, 0})));
  EXPECT_FALSE(Stands(At({0, 0, 0}, {0, 0, 0}, {0, 1.1e-6, 0})));
}

TEST(ObstaclePredictionTest, TheSameStandingIsAtTheSamePlaceAtRest) {
  const std::vector<Obstacle> seen{At({0, 0, 0})};
  EXPECT_TRUE(SameStanding(seen, {At({0.9e-4, 0, 0})}));
  EXPECT_FALSE(SameStanding(seen, {At({1.1e-4, 0, 0})}));
  EXPECT_FALSE(SameStanding(seen, {At({0, 0, 0}, {0.1, 0, 0})}));
  EXPECT_FALSE(SameStanding(seen, {}));
  Obstacle other = At({0, 0, 0});
  other.body = std::make_shared<const ObstacleBody>();
  EXPECT_FALSE(SameStanding(seen, {other}));
}

TEST(ObstaclePredictionTest, IsAsForeseenWithinFiveMillimetresNowAndSoon) {
  const std::vector<Obstacle> seen{At({0, 0, 0}, {0.1, 0, 0})};
  EXPECT_TRUE(AsForeseen({seen}, {std::vector{At({0.0549, 0, 0}, {0.1, 0, 0})}}, 0.5));
  EXPECT_FALSE(AsForeseen({seen}, {std::vector{At({0.0551, 0, 0}, {0.1, 0, 0})}}, 0.5));
  EXPECT_TRUE(AsForeseen({seen}, {std::vector{At({0.05, 0, 0}, {0.116, 0, 0})}},
                         0.5));  // 0.3 s of 0.016 m/s
  EXPECT_FALSE(AsForeseen({seen}, {std::vector{At({0.05, 0, 0}, {0.117, 0, 0})}}, 0.5));
  EXPECT_FALSE(AsForeseen({seen}, {std::vector<Obstacle>{}}, 0.5));
}

ObstacleEstimate Estimated(const Vector3d& acceleration, double sigma = 0.0) {
  ObstacleEstimate estimate;
  estimate.acceleration = acceleration;
  estimate.covariance.diagonal().setConstant(sigma * sigma);
  return estimate;
}

TEST(ObstaclePredictionTest, WithoutAnAccelerationTheLikelyWayIsStraight) {
  const Obstacle obstacle = At({1, 2, 3}, {0.5, 0, 0}, {0, 0, 1});
  const LikelyState likely = LikelyAhead(obstacle, Estimated(Vector3d::Zero()), 0.7);
  EXPECT_EQ(likely.X_WO.matrix(), Foreseen(obstacle, 0.7).matrix());
  EXPECT_EQ(likely.linear, obstacle.linear);
}

TEST(ObstaclePredictionTest, WhatTurnsGoesOnOnItsCircleUpToTwoRadians) {
  // 1 m/s on a circle of 0.5 m: 2 m/s^2 across.
  const Obstacle obstacle = At({0.5, 0, 0}, {0, 1, 0});
  const ObstacleEstimate estimate = Estimated({-2, 0, 0});
  for (const double t : {1e-4, 0.1, 0.5, 0.99}) {
    const LikelyState likely = LikelyAhead(obstacle, estimate, t);
    const Vector3d p(0.5 * std::cos(2 * t), 0.5 * std::sin(2 * t), 0);
    const Vector3d v(-std::sin(2 * t), std::cos(2 * t), 0);
    EXPECT_NEAR((likely.X_WO.translation() - p).norm(), 0.0, 1e-7) << t;
    EXPECT_NEAR((likely.linear - v).norm(), 0.0, 1e-3) << t;
  }
  const LikelyState one = LikelyAhead(obstacle, estimate, 1.0);
  const LikelyState two = LikelyAhead(obstacle, estimate, 2.0);
  EXPECT_NEAR((two.linear - one.linear).norm(), 0.0, 1e-12);
  EXPECT_NEAR((two.X_WO.translation() - one.X_WO.translation() - one.linear).norm(), 0.0, 1e-12);
}

TEST(ObstaclePredictionTest, WhatBrakesStopsAndDoesNotComeBack) {
  const Obstacle obstacle = At({0, 0, 0}, {1, 0, 0});
  const ObstacleEstimate estimate = Estimated({-4, 0, 0});
  const LikelyState late = LikelyAhead(obstacle, estimate, 5.0);
  EXPECT_NEAR(late.linear.norm(), 0.0, 1e-12);
  // It stands when 1 = 4 0.5 (1 - exp(-t / 0.5)), t = 0.5 ln 2.
  const double stop = 0.5 * std::log(2.0);
  EXPECT_NEAR(late.X_WO.translation().x(), stop - 2.0 * (stop - 0.25), 1e-12);
  EXPECT_NEAR(LikelyAhead(obstacle, estimate, 0.01).X_WO.translation().x(), 0.01 - 2e-4, 2e-6);
}

TEST(ObstaclePredictionTest, WhatFallsKeepsFalling) {
  const LikelyState likely = LikelyAhead(At({0, 0, 2}, {1, 0, -1}), Estimated({0.1, 0, -9.7}), 0.5);
  EXPECT_NEAR((likely.X_WO.translation() - Vector3d(0.5125, 0, 2 - 0.5 - 1.2125)).norm(), 0.0,
              1e-12);
  EXPECT_NEAR(likely.linear.z(), -1 - 4.85, 1e-12);
}

TEST(ObstaclePredictionTest, UncertaintyGrowsForThreeTenthsOfASecond) {
  const ObstacleEstimate estimate = Estimated(Vector3d::Zero(), 0.1);
  EXPECT_NEAR(CovarianceAhead(estimate, 0.0)(0, 0), 0.01, 1e-15);
  EXPECT_NEAR(CovarianceAhead(estimate, 0.2)(1, 1), 0.01 * (1 + 0.04), 1e-15);
  EXPECT_EQ(CovarianceAhead(estimate, 2.0), CovarianceAhead(estimate, 0.3));
}

TEST(ObstaclePredictionTest, WhatWasEstimatedMayBeOffByWhatItIsUncertain) {
  const std::vector<Obstacle> seen{At({0, 0, 0}, {0.1, 0, 0})};
  const std::vector<Obstacle> off{At({0.058, 0, 0}, {0.1, 0, 0})};
  const std::vector<ObstacleEstimate> sure{Estimated(Vector3d::Zero())};
  const std::vector<ObstacleEstimate> unsure{Estimated(Vector3d::Zero(), 0.001)};
  EXPECT_FALSE(AsForeseen({seen, sure}, {off, sure}, 0.5));
  EXPECT_TRUE(AsForeseen({seen, unsure}, {off, unsure}, 0.5));  // 3 sqrt(3.27) mm more
  const std::vector<Obstacle> still{At({0, 0, 0})};
  const std::vector<Obstacle> beside{At({0.004, 0, 0})};
  EXPECT_FALSE(SameStanding(still, beside, sure));
  EXPECT_TRUE(SameStanding(still, beside, unsure));
}

/// Looks 0.02 s apart, at velocities along z.
std::vector<ObstacleEstimate> LookAtSpeeds(const std::vector<double>& speeds) {
  VelocityChanges changes;
  std::vector<Obstacle> before;
  std::vector<ObstacleEstimate> estimates;
  for (const double speed : speeds) {
    const std::vector<Obstacle> now{At({0, 0, 0}, {0, 0, speed})};
    estimates = Accelerations(before, now, 0.02, changes);
    before = now;
  }
  return estimates;
}

TEST(ObstaclePredictionTest, AnAccelerationIsWhatTwoLooksAgreeOn) {
  EXPECT_TRUE(LookAtSpeeds({0.0, -0.1}).empty());                    // one look
  EXPECT_FALSE(LookAtSpeeds({0.0, -0.02 * (9.81 + 0.99)}).empty());  // falls
  EXPECT_TRUE(LookAtSpeeds({0.0, -0.02 * (9.81 + 1.01)}).empty());
  const auto falls = LookAtSpeeds({0.0, -0.2, -0.4});
  ASSERT_EQ(falls.size(), 1u);
  EXPECT_NEAR(falls[0].acceleration.z(), -10.0, 1e-12);
  EXPECT_TRUE(falls[0].covariance.isZero(0.0));
  EXPECT_TRUE(LookAtSpeeds({1.0, 1.0, 1.0}).empty());
  EXPECT_TRUE(LookAtSpeeds({0.0, 1.0, 1.0}).empty());      // a jump
  EXPECT_TRUE(LookAtSpeeds({0.0, 0.401, 0.802}).empty());  // beyond 20 m/s^2
  EXPECT_FALSE(LookAtSpeeds({0.0, 0.399, 0.798}).empty());
  EXPECT_FALSE(LookAtSpeeds({0.0, 0.1, 0.1 + 0.149}).empty());  // 5, then 7.45 m/s^2
  EXPECT_TRUE(LookAtSpeeds({0.0, 0.1, 0.1 + 0.151}).empty());
}

TEST(ObstaclePredictionTest, NothingIsForeseenOfAVelocityThatIsNotKnown) {
  std::vector<Obstacle> seen{At({0, 0, 0})};
  EXPECT_TRUE(AsForeseen({seen}, {seen}, 0.1));
  seen[0].velocity_known = false;
  EXPECT_FALSE(AsForeseen({seen}, {seen}, 0.1));
  EXPECT_FALSE(Stands(seen[0]));
}

}  // namespace obstacle_prediction_test
}  // namespace oca::planning
