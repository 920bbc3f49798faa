// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/standing_changes.h"

#include <gmock/gmock.h>

#include "oca/models/robot/kinematics.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace standing_changes_test {

using Eigen::Vector3d;
using geometry::Obstacle;

Obstacle Box(const std::string& id, double x) {
  auto body = std::make_shared<geometry::ObstacleBody>();
  body->id = models::Name(id);
  body->collider = geometry::MakeCollider(geometry::Box{Vector3d(0.1, 0.1, 0.1)}, id);
  Obstacle obstacle;
  obstacle.body = body;
  obstacle.X_WO.translation().x() = x;
  return obstacle;
}

Obstacle MovedTo(Obstacle obstacle, double x) {
  obstacle.X_WO.translation().x() = x;
  return obstacle;
}

TEST(ReachOfTest, HoldsEveryLinkWhereverTheJointsAre) {
  for (const char* name : {"planar3", "lwr4", "ur5e"}) {
    const auto arm = test::Arm(name);
    const ReachBall reach = ReachBallOf(*arm);
    EXPECT_LT(reach.radius, 2.0) << name;
    Eigen::VectorXd q(arm->num_positions());
    for (int k = 0; k < 200; ++k) {
      for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = 2.5 * std::sin(1.3 * k + 2.1 * j * k);
      const auto X_WL = robot::LinkPoses(*arm, q);
      for (const robot::LinkCollider& link : robot::LinkCollidersOf(*arm)) {
        const Vector3d centre = X_WL[static_cast<std::size_t>(link.number)] * link.centre;
        EXPECT_LE((centre - reach.centre).norm() + link.radius, reach.radius + 1e-9) << name;
      }
    }
  }
  EXPECT_NEAR(ReachBallOf(*test::Arm("planar2")).radius, 1.0, 0.1) << "two links of 0.5 m";
}

TEST(StandingChangesTest, WhatIsOutOfReachCountsForNothing) {
  const ReachBall reach{Vector3d::Zero(), 1.0};
  const Obstacle near = Box("near", 0.5);
  for (const double x : {1.08, 1.1}) {  // the ball about a cube of 0.1 m has a radius of 0.0866 m
    const Obstacle other = Box("other", x);
    EXPECT_EQ(SameRest({near}, {near, other}, reach), x > 1.0866) << x;
    EXPECT_EQ(SameRest({near, other}, {near}, reach), x > 1.0866) << x;
  }
}

TEST(StandingChangesTest, WhatComesOpensNoWayAndWhatGoesMay) {
  const ReachBall reach{Vector3d::Zero(), 1.0};
  const Obstacle one = Box("one", 0.5), two = Box("two", 0.7);
  EXPECT_TRUE(AllStay({one}, {two, one}, reach));
  EXPECT_FALSE(SameRest({one}, {two, one}, reach));
  EXPECT_FALSE(AllStay({one, two}, {one}, reach));
  EXPECT_TRUE(AllStay({one}, {MovedTo(one, 0.5 + 0.9e-4)}, reach));
  EXPECT_FALSE(AllStay({one}, {MovedTo(one, 0.5 + 1.1e-4)}, reach));
  Obstacle moving = two;
  moving.linear.x() = 0.1;
  EXPECT_TRUE(AllStay({moving, one}, {one}, reach)) << "it did not stand";
  EXPECT_FALSE(AllStay({two, one}, {moving, one}, reach)) << "it sets off";
}

TEST(StandingChangesTest, NamesWhatStandsWhereItStood) {
  const Obstacle one = Box("one", 0.5), two = Box("two", 0.7), far = Box("far", 9.0);
  std::vector<models::Name> names;
  FindStill({one, two, far}, {far, MovedTo(one, 0.6), two}, names);
  EXPECT_THAT(names, testing::ElementsAre(models::Name("far"), models::Name("two")));
}

}  // namespace standing_changes_test
}  // namespace oca::planning
