// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace path_search_test {

using Eigen::VectorXd;
using State = PathSearch::State;

const VectorXd kStart = Eigen::Vector2d(0.0, 0.0);
const VectorXd kGoal = Eigen::Vector2d(1.5, 0.0);

/// A wall on the diagonal, from near the base to beyond the arm's reach: no fold passes it.
robot::PlacedBody Wall() {
  robot::PlacedBody wall = test::BoxAt({1.3, 0.05, 0.4}, {0.55, 0.55, 0.0});
  wall.X_WO.linear() =
      Eigen::AngleAxisd(0.25 * std::numbers::pi, Eigen::Vector3d::UnitZ()).matrix();
  return wall;
}

SearchLevels Levels() { return {.margins = {0.05, 0.01}, .nodes = 60, .last_nodes = 400}; }

void ExpectClear(robot::Clearance& clearance, const std::vector<VectorXd>& path, double margin) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    for (int k = 0; k <= 200; ++k) {
      clearance.MoveTo(path[i] + 0.005 * k * (path[i + 1] - path[i]));
      EXPECT_GE(clearance.Nearest(1.0).distance, margin - 1e-9);
    }
  }
}

TEST(PathSearchTest, FindsByManySmallLooksWhatOneDoesNot) {
  robot::Clearance clearance(test::Arm("planar2"), false, test::Post());
  PathSearch search;
  EXPECT_EQ(search.state(), State::kIdle);
  search.Begin(kStart, kGoal, true, Levels(), 3);
  long looks = 0;
  search.Continue(clearance, 8, looks);
  EXPECT_EQ(search.state(), State::kSearching) << looks;
  int calls = 1;
  for (; search.state() == State::kSearching && calls < 500; ++calls) {
    search.Continue(clearance, 8, looks);
  }
  ASSERT_EQ(search.state(), State::kFound);
  EXPECT_GT(calls, 2);
  EXPECT_EQ(search.path().front(), kStart);
  EXPECT_EQ(search.path().back(), kGoal);
  ExpectClear(clearance, search.path(), search.margin());
}

TEST(PathSearchTest, SaysTheSameForTheSameCalls) {
  const auto path = [] {
    robot::Clearance clearance(test::Arm("planar2"), false, test::Post());
    PathSearch search;
    search.Begin(kStart, kGoal, true, Levels(), 3);
    long looks = 0;
    for (int i = 0; i < 500; ++i) search.Continue(clearance, 8, looks);
    return search.path();
  };
  EXPECT_EQ(path(), path());
}

TEST(PathSearchTest, GoesOnFromAnotherStartWithWhatItFound) {
  robot::Clearance clearance(test::Arm("planar2"), false, test::Post());
  PathSearch search;
  search.Begin(kStart, kGoal, true, Levels(), 3);
  long looks = 0;
  search.Continue(clearance, 8, looks);
  ASSERT_EQ(search.state(), State::kSearching);
  const VectorXd moved = Eigen::Vector2d(0.02, -0.03);
  search.MoveStart(clearance, moved, looks);
  while (search.state() == State::kSearching) search.Continue(clearance, 100, looks);
  ASSERT_EQ(search.state(), State::kFound);
  EXPECT_EQ(search.path().front(), moved);
  ExpectClear(clearance, search.path(), search.margin());
}

TEST(PathSearchTest, ShortensWhatItFoundWhileTheStartMovesOn) {
  robot::Clearance clearance(test::Arm("planar2"), false, test::Post());
  const auto length_with = [&](int shortcuts) {
    PathSearch search;
    SearchLevels levels = Levels();
    levels.shortcuts = shortcuts;
    search.Begin(kStart, kGoal, true, levels, 3);
    long looks = 0;
    VectorXd start = kStart;
    while (search.state() == State::kSearching) {
      search.MoveStart(clearance, start, looks);
      search.Continue(clearance, 8, looks);
      start[1] = std::max(start[1] - 1e-4, -0.05);
    }
    EXPECT_EQ(search.state(), State::kFound);
    ExpectClear(clearance, search.path(), search.margin());
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < search.path().size(); ++i) {
      length += (search.path()[i + 1] - search.path()[i]).norm();
    }
    return length;
  };
  EXPECT_LT(length_with(150), 0.95 * length_with(0));
}

TEST(PathSearchTest, EndsNearAGoalThatIsWalledIn) {
  const auto arm = test::Arm("planar2");
  robot::Clearance clearance(arm, false, {Wall()});
  CertifiedMotion motion(clearance, 0.01);
  ASSERT_TRUE(motion.Clear(kStart) && motion.Clear(kGoal));
  double least = 10.0;  // on this side of the wall, by a fine grid
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 400; ++j) {
      const Eigen::Vector2d q(0.7 * i / 400.0, -2.0 + j * 0.01);
      if ((q - kGoal).norm() < least && motion.Clear(q)) least = (q - kGoal).norm();
    }
  }
  PathSearch search;
  search.Begin(kStart, kGoal, true, Levels(), 3);
  long looks = 0;
  for (int i = 0; i < 10000 && search.state() == State::kSearching; ++i) {
    search.Continue(clearance, 200, looks);
  }
  ASSERT_EQ(search.state(), State::kExhausted);
  EXPECT_LT(search.nearest_distance(), 1.1 * least);
  EXPECT_EQ(search.nearest_distance(), (search.nearest() - kGoal).norm());
  ExpectClear(clearance, search.PathToNearest(), 0.01);
  // What was reached is a goal to which the way is known, from another start too.
  const VectorXd nearest = search.nearest();
  search.AimAtNearest();
  EXPECT_TRUE(search.IsFor(nearest));
  ASSERT_EQ(search.state(), State::kFound);
  EXPECT_EQ(search.path().front(), kStart);
  EXPECT_EQ(search.path().back(), nearest);
  const VectorXd beside = kStart + VectorXd(Eigen::Vector2d(0.01, -0.01));
  search.MoveStart(clearance, beside, looks);
  ASSERT_EQ(search.state(), State::kFound);
  EXPECT_EQ(search.path().front(), beside);
  EXPECT_EQ(search.path().back(), nearest);
  ExpectClear(clearance, search.path(), 0.01);
}

TEST(PathSearchTest, EndsNearAGoalThatIsInContact) {
  const auto arm = test::Arm("planar2");
  robot::Clearance clearance(arm, false, {test::BoxAt({0.2, 0.2, 0.4}, {0.0, 0.8, 0.0})});
  CertifiedMotion motion(clearance, 0.01);
  const VectorXd goal = Eigen::Vector2d(0.5 * std::numbers::pi, 0.0);
  ASSERT_FALSE(motion.Clear(goal));
  PathSearch search;
  SearchLevels levels = Levels();
  levels.patience = 2000;
  search.Begin(kStart, goal, false, levels, 3);
  long looks = 0;
  while (search.state() == State::kSearching) search.Continue(clearance, 200, looks);
  EXPECT_EQ(search.state(), State::kExhausted);
  double least = 10.0;
  for (int i = 0; i < 600; ++i) {
    for (int j = 0; j < 600; ++j) {
      const Eigen::Vector2d q(0.5 + 0.004 * i, -1.2 + j * 0.004);
      if ((q - goal).norm() < least && motion.Clear(q)) least = (q - goal).norm();
    }
  }
  EXPECT_LT(search.nearest_distance(), 1.1 * least);
  EXPECT_TRUE(motion.Clear(search.nearest()));
}

TEST(PathSearchTest, IsForOneGoal) {
  PathSearch search;
  EXPECT_FALSE(search.IsFor(kGoal));
  search.Begin(kStart, kGoal, true, Levels(), 3);
  EXPECT_TRUE(search.IsFor(kGoal));
  EXPECT_FALSE(search.IsFor(kGoal + VectorXd::Constant(2, 1e-6)));
  search.Reset();
  EXPECT_FALSE(search.IsFor(kGoal));
}

}  // namespace path_search_test
}  // namespace oca::planning
