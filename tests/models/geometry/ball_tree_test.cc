// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ball_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>
#include <random>

#include "oca/models/geometry/near_balls.h"

namespace oca::geometry {
namespace ball_tree_test {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RandomBalls {
 public:
  explicit RandomBalls(unsigned seed) : generator_(seed) {}
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int Index(std::size_t count) { return static_cast<int>(generator_() % count); }
  Vector3d Point(double half) {
    return {Uniform(-half, half), Uniform(-half, half), Uniform(-half, half)};
  }
  Ball Next(double half) { return {Point(half), Uniform(0.0, 0.2)}; }
  std::vector<Ball> Many(int count, double half) {
    std::vector<Ball> balls;
    for (int i = 0; i < count; ++i) balls.push_back(Next(half));
    return balls;
  }

 private:
  std::mt19937_64 generator_;
};

std::vector<int> OneByOne(const std::vector<Ball>& balls, const Vector3d& point, double reach) {
  std::vector<int> found;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if ((balls[i].centre - point).norm() <= reach + balls[i].radius) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

std::vector<int> Near(const BallTree& tree, const Vector3d& point, double reach) {
  std::vector<int> found;
  tree.FindNear(point, reach, found);
  return found;
}

TEST(BallTreeTest, FindsBallsUpToTheirRimAndNotBeyond) {
  const std::vector<Ball> balls{{{1.0, 0.0, 0.0}, 0.25}, {{0.0, 2.0, 0.0}, 0.5}};
  BallTree tree;
  tree.Build(balls);
  EXPECT_THAT(Near(tree, Vector3d::Zero(), 0.749), IsEmpty());
  EXPECT_THAT(Near(tree, Vector3d::Zero(), 0.75), ElementsAre(0));
  EXPECT_THAT(Near(tree, Vector3d::Zero(), 1.5), ElementsAre(0, 1));
}

TEST(BallTreeTest, FindsNothingAmongNothing) {
  BallTree tree;
  EXPECT_THAT(Near(tree, Vector3d::Zero(), 1.0), IsEmpty());
  tree.Build({});
  EXPECT_THAT(Near(tree, Vector3d::Zero(), 1.0), IsEmpty());
}

TEST(BallTreeTest, FindsWhatALookAtEachFindsWhileBallsMove) {
  for (const int count : {1, 7, 8, 9, 17, 300, 3000}) {
    RandomBalls random(static_cast<unsigned>(count));
    std::vector<Ball> balls = random.Many(count, 1.0);
    BallTree tree;
    tree.Build(balls);
    std::size_t total = 0;
    for (int i = 0; i < 300; ++i) {
      const Vector3d point = random.Point(1.2);
      const double reach = random.Uniform(0.0, 0.5);
      const auto expected = OneByOne(balls, point, reach);
      ASSERT_EQ(Near(tree, point, reach), expected) << count << " balls, search " << i;
      total += expected.size();
      const int moved = random.Index(balls.size());
      balls[static_cast<std::size_t>(moved)] = random.Next(1.0);
      tree.Move(moved, balls[static_cast<std::size_t>(moved)]);
    }
    EXPECT_GT(total, 0u) << count;
  }
}

TEST(BallTreeTest, FindsAllOfManyBallsInOnePlace) {
  BallTree tree;
  tree.Build(std::vector<Ball>(100, Ball{Vector3d::Ones(), 0.1}));
  EXPECT_EQ(Near(tree, Vector3d::Ones(), 0.0).size(), 100u);
  EXPECT_THAT(Near(tree, Vector3d::Zero(), 1.0), IsEmpty());
}

TEST(BallTreeTest, CountsWhatHasNoEndAsNear) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  BallTree tree;
  tree.Build(std::vector<Ball>{{Vector3d::Zero(), kInfinity},
                               {Vector3d(5.0, 0.0, 0.0), 0.1},
                               {Vector3d(kNaN, 0.0, 0.0), 0.1}});
  EXPECT_THAT(Near(tree, Vector3d(-100.0, 0.0, 0.0), 1.0), ElementsAre(0, 2));
}

TEST(BallTreeTest, SearchVisitsTheNearestAndFewOthers) {
  RandomBalls random(5);
  const std::vector<Ball> balls = random.Many(10'000, 1.0);
  BallTree tree;
  tree.Build(balls);
  int visits = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d point = random.Point(1.5);
    double expected = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) {
      expected = std::min(expected, (ball.centre - point).norm() - ball.radius);
    }
    double nearest = std::numeric_limits<double>::infinity();
    tree.Search(
        [&](const Vector3d& centre, double radius) { return (centre - point).norm() - radius; },
        [&] { return nearest; },
        [&](int index) {
          ++visits;
          const Ball& ball = tree.ball(index);
          nearest = std::min(nearest, (ball.centre - point).norm() - ball.radius);
        });
    ASSERT_EQ(nearest, expected);
  }
  EXPECT_LT(visits, 200 * 100);
}

// At the rim too, where another rounding would tell, and where a leaf has gaps.
TEST(BallTreeTest, VectorInstructionsFindWhatPlainOnesFind) {
  RandomBalls random(15);
  constexpr int kCount = internal::kBallsOfLeaf;
  int near = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::array<double, 4 * kCount> leaf;
    const Vector3d point = random.Point(1.0);
    const double reach = random.Uniform(0.0, 1.0);
    for (int k = 0; k < kCount; ++k) {
      const Ball ball = random.Next(1.0);
      const double rim = (ball.centre - point).norm() - reach;
      for (int axis = 0; axis < 3; ++axis) leaf[axis * kCount + k] = ball.centre[axis];
      leaf[3 * kCount + k] = rim > 0.0 && k % 2 == 0 ? rim : ball.radius;
      if (k == 5) leaf[k] = std::numeric_limits<double>::infinity();
      if (k == 6) leaf[k] = leaf[3 * kCount + k] = std::numeric_limits<double>::infinity();
    }
    const unsigned found = internal::NearBalls(leaf.data(), point, reach);
    ASSERT_EQ(found, internal::NearBallsPortable(leaf.data(), point, reach));
    ASSERT_EQ(found & (1u << 5 | 1u << 6), 0u);
    near += std::popcount(found);
  }
  EXPECT_GT(near, 100'000);
  EXPECT_LT(near, 500'000);
}

}  // namespace ball_tree_test
}  // namespace oca::geometry
