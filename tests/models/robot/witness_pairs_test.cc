// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/witness_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot {
namespace witness_pairs_test {

/// planar2 with something below the middle of its second link, which begins at x = 0.5.
class WitnessPairsTest : public testing::Test {
 protected:
  WitnessPairsTest()
      : model_(LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf")),
        X_WL_(LinkPoses(model_, Eigen::Vector2d::Zero())) {
    Proximity& proximity = set_.proximities.emplace_back();
    proximity.link = models::Name("planar2_link_2");
    proximity.obstacle = models::Name("box");
    MoveTo(0.7);
  }
  Proximity& MoveTo(double x) {
    Proximity& proximity = set_.proximities[0];
    proximity.point_on_link = Eigen::Vector3d(x, 0.0, 0.0);
    proximity.point_on_obstacle = Eigen::Vector3d(x, 0.0, -0.1);
    proximity.normal = Eigen::Vector3d::UnitZ();
    proximity.distance = 0.1;
    return proximity;
  }
  void Keep() { witnesses_.Keep(model_, X_WL_, set_.proximities[0]); }

  const RobotModel model_;
  const std::vector<Eigen::Isometry3d> X_WL_;
  ProximitySet set_;
  WitnessPairs witnesses_;
};

TEST_F(WitnessPairsTest, TheLinkTakesItsPointAlong) {
  Keep();
  const auto turned = LinkPoses(model_, Eigen::Vector2d(1.5707963267948966, 0.0));
  const Proximity between = Between(model_, turned, witnesses_.pairs()[0], set_.proximities[0]);
  EXPECT_TRUE(between.point_on_link.isApprox(Eigen::Vector3d(0.0, 0.7, 0.0), 1e-12));
  EXPECT_TRUE(between.point_on_obstacle.isApprox(Eigen::Vector3d(0.7, 0.0, -0.1), 1e-12));
  EXPECT_NEAR(between.distance, std::sqrt(0.99), 1e-12);
  EXPECT_NEAR(between.normal.dot(between.point_on_link - between.point_on_obstacle),
              between.distance, 1e-12);
}

TEST_F(WitnessPairsTest, TheObstacleMovesOn) {
  Keep();
  set_.proximities[0].obstacle_velocity = Eigen::Vector3d(0.0, 0.2, 0.0);
  witnesses_.Move(0.1, set_);
  EXPECT_TRUE(
      witnesses_.pairs()[0].point_on_obstacle.isApprox(Eigen::Vector3d(0.7, 0.02, -0.1), 1e-12));
}

TEST_F(WitnessPairsTest, AnOwnLinkTakesItsPointAlongToo) {
  Proximity& proximity = MoveTo(0.7);
  proximity.own_link = proximity.obstacle = models::Name("planar2_link_1");
  proximity.point_on_obstacle = Eigen::Vector3d(0.3, 0.0, -0.1);
  Keep();
  const auto turned = LinkPoses(model_, Eigen::Vector2d(1.5707963267948966, 0.0));
  const Proximity between = Between(model_, turned, witnesses_.pairs()[0], proximity);
  EXPECT_TRUE(between.point_on_obstacle.isApprox(Eigen::Vector3d(0.0, 0.3, -0.1), 1e-12));
}

TEST_F(WitnessPairsTest, TheSamePointIsKeptOnce) {
  Keep();
  witnesses_.Move(0.1, set_);
  MoveTo(0.7005);
  Keep();
  ASSERT_EQ(witnesses_.pairs().size(), 1u);
  EXPECT_EQ(witnesses_.pairs()[0].age, 0.0);
}

TEST_F(WitnessPairsTest, TheOldestOfABodyGivesWay) {
  for (int i = 0; i <= WitnessPairs::kOfABody; ++i) {
    MoveTo(0.6 + 0.05 * i);
    Keep();
    witnesses_.Move(0.01, set_);
  }
  ASSERT_EQ(witnesses_.pairs().size(), std::size_t{WitnessPairs::kOfABody});
  for (const WitnessPair& pair : witnesses_.pairs()) EXPECT_GT(pair.point_on_link.x(), 0.1 + 1e-3);
}

TEST_F(WitnessPairsTest, ThereIsRoomForSoManyOfAllBodies) {
  for (int i = 0; i < WitnessPairs::kMost + 5; ++i) {
    set_.proximities[0].obstacle = models::Name(std::to_string(i));
    Keep();
  }
  EXPECT_EQ(witnesses_.pairs().size(), std::size_t{WitnessPairs::kMost});
}

TEST_F(WitnessPairsTest, WhatIsOldOrGoneIsForgotten) {
  Keep();
  witnesses_.Move(0.5 * WitnessPairs::kKept, set_);
  EXPECT_EQ(witnesses_.pairs().size(), 1u);
  witnesses_.Move(0.6 * WitnessPairs::kKept, set_);
  EXPECT_TRUE(witnesses_.pairs().empty());
  Keep();
  set_.proximities[0].obstacle = models::Name("ball");
  witnesses_.Move(0.01, set_);
  EXPECT_TRUE(witnesses_.pairs().empty());
}

}  // namespace witness_pairs_test
}  // namespace oca::robot
