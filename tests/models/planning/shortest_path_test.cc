// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/shortest_path.h"

#include <gtest/gtest.h>

#include "oca/models/planning/certified_motion.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace shortest_path_test {

using test::Arm;

const Eigen::VectorXd kFrom = Eigen::Vector2d(0.0, 0.0);
const Eigen::VectorXd kTo = Eigen::Vector2d(1.5, 0.0);

TEST(ShortestPathTest, LengthIsTheSumOfTheWays) {
  EXPECT_EQ(PathLength({}), 0.0);
  EXPECT_EQ(PathLength({Eigen::Vector2d(1.0, 1.0)}), 0.0);
  EXPECT_EQ(
      PathLength({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(3.0, 4.0), Eigen::Vector2d(3.0, 3.0)}),
      6.0);
}

TEST(ShortestPathTest, IsStraightWhereThatIsClear) {
  robot::Clearance clearance(Arm("planar2"));
  const auto path = ShortestPath(clearance, kFrom, kTo);
  ASSERT_TRUE(path);
  EXPECT_EQ(PathLength(*path), 1.5);
}

TEST(ShortestPathTest, ComesOutShorterTheMoreIsTriedAndStaysClear) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  const auto length = [&](int tries) {
    const auto path = ShortestPath(clearance, kFrom, kTo, {.seconds = 60.0, .most_tries = tries});
    CertifiedMotion motion(clearance, 0.0009);  // a proof goes down to pieces of 1e-4 rad
    for (std::size_t i = 1; i < path->size(); ++i) {
      EXPECT_TRUE(motion.Clear((*path)[i - 1], (*path)[i]));
    }
    EXPECT_EQ(path->front(), kFrom);
    EXPECT_EQ(path->back(), kTo);
    return PathLength(*path);
  };
  const double first = length(1), best = length(8);
  EXPECT_GT(best, 1.5);
  EXPECT_LE(best, first);
  EXPECT_EQ(length(8), best);
  const auto found = RrtConnect(clearance, kFrom, kTo, {.margin = 0.001, .shortcuts = 0});
  EXPECT_LT(best, PathLength(*found));
}

TEST(ShortestPathTest, IsNoneWhereTheGoalIsInContact) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  EXPECT_FALSE(ShortestPath(clearance, kFrom, Eigen::Vector2d(0.785, 0.0), {.seconds = 0.01}));
}

}  // namespace shortest_path_test
}  // namespace oca::planning
