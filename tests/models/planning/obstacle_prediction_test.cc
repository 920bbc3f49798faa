// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/obstacle_prediction.h"

#include <gtest/gtest.h>

#include <numbers>

namespace oca::planning {
namespace obstacle_prediction_test {

using Eigen::Vector3d;
using geometry::Obstacle;
using geometry::ObstacleBody;

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
  EXPECT_TRUE(AsForeseen(seen, {At({0.0549, 0, 0}, {0.1, 0, 0})}, 0.5));
  EXPECT_FALSE(AsForeseen(seen, {At({0.0551, 0, 0}, {0.1, 0, 0})}, 0.5));
  EXPECT_TRUE(AsForeseen(seen, {At({0.05, 0, 0}, {0.116, 0, 0})}, 0.5));  // 0.3 s of 0.016 m/s
  EXPECT_FALSE(AsForeseen(seen, {At({0.05, 0, 0}, {0.117, 0, 0})}, 0.5));
  EXPECT_FALSE(AsForeseen(seen, {}, 0.5));
}

}  // namespace obstacle_prediction_test
}  // namespace oca::planning
