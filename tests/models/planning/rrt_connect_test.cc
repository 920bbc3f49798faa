// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/rrt_connect.h"

#include <gtest/gtest.h>

#include "oca/models/planning/certified_motion.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace rrt_connect_test {

using test::Arm;
using test::BoxAt;

const Eigen::VectorXd kStart = Eigen::Vector2d(0.0, 0.0);
const Eigen::VectorXd kGoal = Eigen::Vector2d(1.5, 0.0);

void ExpectClear(robot::Clearance& clearance, const std::vector<Eigen::VectorXd>& path,
                 double margin) {
  const robot::RobotModel& model = clearance.model();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    for (int k = 0; k <= 200; ++k) {
      const Eigen::VectorXd q = path[i] + 0.005 * k * (path[i + 1] - path[i]);
      EXPECT_TRUE((q.array() >= model.lower_limits().array()).all());
      EXPECT_TRUE((q.array() <= model.upper_limits().array()).all());
      clearance.MoveTo(q);
      EXPECT_GE(clearance.Nearest(1.0).distance, margin - 1e-9);
    }
  }
}

TEST(RrtConnectTest, GoesStraightWhereNothingStands) {
  robot::Clearance clearance(Arm("planar2"));
  const auto path = RrtConnect(clearance, kStart, kGoal);
  ASSERT_TRUE(path);
  EXPECT_EQ(*path, (std::vector<Eigen::VectorXd>{kStart, kGoal}));
}

TEST(RrtConnectTest, FoldsTheArmToPassAPostAndStaysClearBetweenThePoints) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  CertifiedMotion motion(clearance, 0.01);
  ASSERT_FALSE(motion.Clear(kStart, kGoal));
  const auto path = RrtConnect(clearance, kStart, kGoal, {.seed = 3});
  ASSERT_TRUE(path);
  EXPECT_EQ(path->front(), kStart);
  EXPECT_EQ(path->back(), kGoal);
  EXPECT_GT(path->size(), 2u);
  ExpectClear(clearance, *path, 0.01);
}

TEST(RrtConnectTest, FindsAWayForSevenJoints) {
  robot::Clearance clearance(Arm("lwr4"), true, {BoxAt({0.2, 0.2, 0.2}, {0.0, 0.6, 0.15})});
  Eigen::VectorXd start(7);
  start << 0.0, 1.48, 0.0, -0.61, 0.0, 0.52, 0.0;
  Eigen::VectorXd goal = start;
  goal[0] = 2.75;
  ASSERT_FALSE(CertifiedMotion(clearance, 0.01).Clear(start, goal));
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto path = RrtConnect(clearance, start, goal, {.seed = seed});
    ASSERT_TRUE(path) << seed;
    ExpectClear(clearance, *path, 0.01);
  }
}

TEST(RrtConnectTest, GivesTheSamePathForTheSameSeedOnly) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  const auto path = RrtConnect(clearance, kStart, kGoal, {.seed = 3});
  EXPECT_EQ(path, RrtConnect(clearance, kStart, kGoal, {.seed = 3}));
  EXPECT_NE(path, RrtConnect(clearance, kStart, kGoal, {.seed = 4}));
}

TEST(RrtConnectTest, TheWorkIsBoundedHoweverFarTheWay) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  for (const double far : {1e3, 1e6, 1e15}) {
    Eigen::VectorXd goal = kGoal;
    goal[0] += far;
    // 300 edges at most, none longer than half a radian: that far no tree grows.
    EXPECT_FALSE(RrtConnect(clearance, kStart, goal, {.most_nodes = 300})) << far;
    EXPECT_FALSE(RrtConnect(clearance, goal, kStart, {.most_nodes = 300})) << far;
  }
}

TEST(RrtConnectTest, HasNoPathThroughAClosedWallOrFromContact) {
  // A ring of plates around the stretched arm's end: it cannot fold out of it.
  std::vector<robot::PlacedBody> walls{BoxAt({0.5, 0.01, 0.4}, {0.3, 0.2, 0.0}),
                                       BoxAt({0.5, 0.01, 0.4}, {0.3, -0.2, 0.0})};
  robot::Clearance closed(Arm("planar2"), false, walls);
  EXPECT_FALSE(RrtConnect(closed, kStart, kGoal, {.most_nodes = 300}));
  robot::Clearance touching(Arm("planar2"), false, {BoxAt({0.1, 0.1, 0.1}, {0.5, 0.0, 0.0})});
  EXPECT_FALSE(RrtConnect(touching, kStart, kGoal));
  EXPECT_FALSE(RrtConnect(touching, kGoal, kStart));
}

TEST(RrtConnectTest, ShortensAPathAndKeepsItClear) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  const auto length = [](const std::vector<Eigen::VectorXd>& path) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) sum += (path[i + 1] - path[i]).norm();
    return sum;
  };
  const auto raw = RrtConnect(clearance, kStart, kGoal, {.seed = 3, .shortcuts = 0});
  auto shorter = raw;
  ASSERT_TRUE(shorter);
  Shorten(clearance, {.seed = 3}, *shorter);
  EXPECT_LE(length(*shorter), length(*raw));
  ExpectClear(clearance, *shorter, 0.01);
}

}  // namespace rrt_connect_test
}  // namespace oca::planning
