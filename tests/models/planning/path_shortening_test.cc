// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_shortening.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/planning/rrt_connect.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace path_shortening_test {

using Eigen::VectorXd;
using Path = PathShortening::Path;

constexpr double kMargin = 0.01;
constexpr int kTries = 150;
constexpr long kAll = std::numeric_limits<long>::max();
const VectorXd kStart = Eigen::Vector2d(0.0, 0.0);
const VectorXd kGoal = Eigen::Vector2d(1.5, 0.0);

/// Past a post, with more corners than it needs.
class PathShorteningTest : public testing::Test {
 protected:
  PathShorteningTest()
      : clearance_(test::Arm("planar2"), false, test::Post()),
        path_(*RrtConnect(clearance_, kStart, kGoal, {.seed = 3, .shortcuts = 0})) {}

  static double Length(const Path& path) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) sum += (path[i + 1] - path[i]).norm();
    return sum;
  }
  void ExpectClear(const Path& path) {
    CertifiedMotion motion(clearance_, kMargin);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      EXPECT_TRUE(motion.Clear(path[i], path[i + 1])) << i;
    }
  }

  robot::Clearance clearance_;
  const Path path_;
  long looks_{0};
};

TEST_F(PathShorteningTest, ManySmallCallsGiveThePathOfOne) {
  PathShortening at_once(path_, kMargin, 7, kTries);
  EXPECT_FALSE(at_once.done());
  at_once.Continue(clearance_, kAll, looks_);
  EXPECT_TRUE(at_once.done());
  EXPECT_LT(Length(at_once.path()), 0.95 * Length(path_));
  ExpectClear(at_once.path());

  PathShortening by_parts(path_, kMargin, 7, kTries);
  long looks = 0;
  int calls = 0;
  for (; !by_parts.done(); ++calls) {
    const long before = looks;
    by_parts.Continue(clearance_, 10, looks);
    EXPECT_LT(looks - before, 10 + 200) << "it ends after the motion that it is at";
  }
  EXPECT_GT(calls, 2);
  EXPECT_EQ(by_parts.path(), at_once.path());
}

TEST_F(PathShorteningTest, AStraightPathIsDone) {
  EXPECT_TRUE(PathShortening({kStart, kGoal}, kMargin, 7, kTries).done());
  EXPECT_TRUE(PathShortening(path_, kMargin, 7, 0).done());
}

TEST_F(PathShorteningTest, ItsStartMovesAsFarAsAClearMotionLeadsBack) {
  PathShortening shortening(path_, kMargin, 7, kTries);
  shortening.Continue(clearance_, 20, looks_);
  const VectorXd moved = Eigen::Vector2d(0.02, -0.03);
  ASSERT_TRUE(shortening.MoveStart(clearance_, moved, looks_));
  shortening.Continue(clearance_, kAll, looks_);
  EXPECT_EQ(shortening.path().front(), moved);
  EXPECT_EQ(shortening.path().back(), kGoal);
  ExpectClear(shortening.path());

  const Path before = shortening.path();
  EXPECT_FALSE(shortening.MoveStart(clearance_, Eigen::Vector2d(3.0, 0.0), looks_));
  EXPECT_EQ(shortening.path(), before);
}

}  // namespace path_shortening_test
}  // namespace oca::planning
