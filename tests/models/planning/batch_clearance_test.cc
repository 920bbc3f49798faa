// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/batch_clearance.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdio>
#include <limits>
#include <numbers>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/planning/batch_kernel.h"
#include "oca/models/random.h"
#include "tests/models/geometry/random_bodies.h"
#include "tests/models/planning/scene.h"
#include "tests/sanitized.h"

namespace oca::planning {
namespace batch_clearance_test {

using test::Arm;
using test::BoxAt;

// Of eight configurations, for each of four arms: 10^6 in all.
constexpr int kBatches = kSanitized ? 500 : 32000;

/// Twenty solids of all kinds about the arm, a floor under it.
std::vector<robot::PlacedBody> Clutter(unsigned seed, double size = 1.0) {
  geometry::RandomBodies random(seed);
  std::vector<robot::PlacedBody> bodies;
  for (int i = 0; i < 20; ++i) {
    robot::PlacedBody body{
        geometry::MakeCollider(random.RandomShape(i % geometry::RandomBodies::kKinds), "solid")};
    body.X_WO = random.Pose(1.0);
    body.X_WO.translation() = size * random.Uniform(0.3, 1.1) * random.Direction();
    if (i % 4 == 0) body.covariance = Eigen::Vector3d(1e-4, 0.0, 4e-4).asDiagonal();
    bodies.push_back(body);
  }
  robot::PlacedBody floor{geometry::MakeCollider(geometry::HalfSpace{}, "floor")};
  floor.X_WO.translation().z() = -0.2;
  bodies.push_back(floor);
  return bodies;
}

Eigen::MatrixXd Draw(const robot::RobotModel& model, models::Random& random) {
  Eigen::MatrixXd q(model.num_positions(), BatchClearance::kLanes);
  for (Eigen::Index lane = 0; lane < q.cols(); ++lane) {
    for (Eigen::Index j = 0; j < q.rows(); ++j) {
      q(j, lane) = random.Uniform(std::max(model.lower_limits()[j], -7.0),
                                  std::min(model.upper_limits()[j], 7.0));
    }
  }
  return q;
}

unsigned ExactlyClear(robot::Clearance& clearance, const Eigen::MatrixXd& q, double margin) {
  unsigned clear = 0;
  for (int lane = 0; lane < BatchClearance::kLanes; ++lane) {
    clearance.MoveTo(q.col(lane));
    if (!clearance.NearerThan(margin)) clear |= 1u << lane;
  }
  return clear;
}

class BatchClearanceTest : public testing::TestWithParam<const char*> {};

TEST_P(BatchClearanceTest, NeverCallsClearWhatIsNotOn250000Configurations) {
  models::Random random(5);
  std::int64_t clear_by_balls = 0, clear = 0, looked_at = 0, exactly = 0, needless = 0;
  for (int scene = 0; scene < 10; ++scene) {
    robot::Clearance clearance(Arm(GetParam()), true, Clutter(static_cast<unsigned>(scene)));
    BatchClearance batch(clearance);
    for (int i = 0; i < kBatches / 10; ++i) {
      const double margin = i % 3 == 0 ? 0.0 : random.Uniform(0.0, 0.05);
      const Eigen::MatrixXd q = Draw(clearance.model(), random);
      const unsigned sure = batch.SurelyClear(q, BatchClearance::kLanes, margin);
      const unsigned exact = ExactlyClear(clearance, q, margin);
      ASSERT_EQ(sure & ~exact, 0u) << "scene " << scene << ", batch " << i;
      const std::int64_t before = batch.undecided();
      ASSERT_EQ(batch.Clear(q, BatchClearance::kLanes, margin), exact);
      looked_at += BatchClearance::kLanes;
      exactly += batch.undecided() - before;
      needless += std::popcount(exact & ~sure);  // what is looked at exactly and turns out clear
      clear_by_balls += std::popcount(sure);
      clear += std::popcount(exact);
    }
    EXPECT_GT(batch.num_balls(), 10);
  }
  // What the balls are good for: much of what is clear they call clear.
  EXPECT_GT(static_cast<double>(clear_by_balls), 0.4 * static_cast<double>(clear));
  const auto share = [](std::int64_t part, std::int64_t all) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(all);
  };
  std::printf(
      "%s: balls decide %.1f %% of what is clear; of %ld configurations %.1f %% were looked at "
      "exactly, %.1f %% needlessly\n",
      GetParam(), share(clear_by_balls, clear), static_cast<long>(looked_at),
      share(exactly, looked_at), share(needless, looked_at));
}

TEST_P(BatchClearanceTest, IsClearWhereverJointsGoAround) {
  models::Random random(7);
  int clear = 0, contact = 0;
  for (int scene = 0; scene < 10; ++scene) {
    robot::Clearance clearance(Arm(GetParam()), true, Clutter(static_cast<unsigned>(scene), 1.5));
    BatchClearance batch(clearance);
    for (int i = 0; i < kBatches / 200; ++i) {
      const double margin = i % 3 == 0 ? 0.0 : random.Uniform(0.0, 0.05);
      const double most = random.Uniform(0.0, i % 2 == 0 ? 0.01 : 0.1);
      const Eigen::MatrixXd q = Draw(clearance.model(), random);
      Eigen::MatrixXd path = q;
      for (double& part : path.reshaped()) part = random.Uniform(0.0, most);
      const BatchClearance::Around around =
          batch.ClearAround(q, path, BatchClearance::kLanes, margin);
      ASSERT_EQ(around.contact & ExactlyClear(clearance, q, margin), 0u);
      for (int k = 0; k < 5; ++k) {
        Eigen::MatrixXd moved = q;
        for (Eigen::Index j = 0; j < q.size(); ++j) {
          // Corners too, where all joints go as far as they may.
          const double part = k == 0 ? 1.0 : k == 1 ? -1.0 : random.Uniform(-1.0, 1.0);
          moved(j) += part * path(j);
        }
        ASSERT_EQ(around.clear & ~ExactlyClear(clearance, moved, margin), 0u) << scene << ", " << i;
      }
      clear += std::popcount(around.clear);
      contact += std::popcount(around.contact);
    }
  }
  EXPECT_GT(clear, 10);
  EXPECT_GT(contact, 10);
}

TEST_P(BatchClearanceTest, AllProcessorsGiveTheSameBits) {
  models::Random random(6);
  robot::Clearance clearance(Arm(GetParam()), true, Clutter(3));
  const internal::BatchScene scene = BatchClearance(clearance).scene();
  internal::BatchWorkspace here(scene), portable(scene);
  std::vector<internal::LaneArray> motion(scene.frames.size()), paths(scene.frames.size());
  for (int i = 0; i < 3000; ++i) {
    for (auto& joint : motion) {
      for (float& lane : joint) lane = static_cast<float>(random.Uniform(-3.14, 3.14));
    }
    const float margin = static_cast<float>(random.Uniform(0.0, 0.1));
    for (auto& joint : paths) {
      for (float& lane : joint) lane = static_cast<float>(random.Uniform(0.0, 0.1));
    }
    const internal::BatchQuestion question{
        motion.data(), i % 2 == 0 ? nullptr : paths.data(), nullptr, margin, 1e-5f, 0xffu,
        i % 3 == 0};
    const internal::BatchAnswer answer = CheckLanes(scene, question, here);
    const internal::BatchAnswer other = CheckLanesPortable(scene, question, portable);
    ASSERT_EQ(answer.open, other.open);
    ASSERT_EQ(answer.surely, other.surely);
    ASSERT_EQ(here.found.size(), portable.found.size());
    for (std::size_t k = 0; k < here.found.size(); ++k) {
      ASSERT_EQ(here.found[k].link, portable.found[k].link);
      ASSERT_EQ(here.found[k].lanes, portable.found[k].lanes);
    }
    ASSERT_EQ(here.frames, portable.frames);  // bit for bit, no number is a NaN
    ASSERT_EQ(here.centres, portable.centres);
    ASSERT_EQ(here.travels, portable.travels);
  }
}

/// Every third of Clutter's solids is elsewhere at each configuration.
TEST_P(BatchClearanceTest, TellsAllPairsThatMayBeNearAmongBodiesThatMove) {
  models::Random random(8);
  geometry::RandomBodies places(9);
  robot::Clearance clearance(Arm(GetParam()), true, Clutter(4));
  clearance.Ignore(clearance.links().back().number, 1);
  std::vector<int> moving;
  for (int body = 0; body < 20; body += 3) moving.push_back(body);
  BatchClearance batch(clearance, moving);
  std::vector<robot::NearPair> all, some;
  std::vector<robot::PairPlace> of;
  long near = 0, told = 0;
  for (int i = 0; i < 2000; ++i) {
    const int count = 1 + i % BatchClearance::kLanes;
    const double margin = i % 5 == 0 ? 0.0 : random.Uniform(0.0, 0.15);
    const Eigen::MatrixXd q = Draw(clearance.model(), random);
    std::vector<Eigen::Isometry3d> poses;
    std::vector<BatchClearance::MovingBall> balls;
    for (int lane = 0; lane < count; ++lane) {
      for (const int body : moving) {
        const robot::PlacedBody& placed = clearance.bodies()[static_cast<std::size_t>(body)];
        poses.push_back(places.Pose(1.2));
        const double uncertain = geometry::kConfidence * std::sqrt(placed.covariance.trace());
        balls.push_back({poses.back() * placed.collider->centre(),
                         placed.collider->bounding_radius() + uncertain});
      }
    }
    const auto candidates = batch.Near(q, count, margin, balls);
    for (int lane = 0; lane < count; ++lane) {
      of.clear();
      for (const auto& candidate : candidates) {
        if ((candidate.lanes >> lane & 1u) != 0) of.push_back(candidate.pair);
      }
      clearance.MoveTo(q.col(lane));
      for (std::size_t m = 0; m < moving.size(); ++m) {
        clearance.MoveBody(moving[m], poses[static_cast<std::size_t>(lane) * moving.size() + m]);
      }
      clearance.Collect(margin, all);
      clearance.Collect(margin, of, some);
      ASSERT_EQ(all.size(), some.size()) << i;
      for (std::size_t k = 0; k < all.size(); ++k) {  // in the same order, bit for bit
        ASSERT_EQ(all[k].link, some[k].link);
        ASSERT_EQ(all[k].body, some[k].body);
        ASSERT_EQ(all[k].other_link, some[k].other_link);
        ASSERT_EQ(all[k].distance, some[k].distance);
        ASSERT_EQ(all[k].normal, some[k].normal);
      }
      near += std::ssize(all);
      told += std::ssize(of);
    }
  }
  EXPECT_GT(near, 500);
  EXPECT_LT(told, 6 * near);
  std::printf("%s: %.2f candidates a pair that is near\n", GetParam(),
              static_cast<double>(told) / static_cast<double>(near));
}

INSTANTIATE_TEST_SUITE_P(Arms, BatchClearanceTest,
                         testing::Values("lwr4", "ur5e", "iiwa14", "planar3"));

TEST(BatchClearanceBoundaryTest, TheMarginDecidesFromBothSides) {
  // Stretched along x, the tip of the arm at x = 1.2 or so: a ball beside the first link.
  robot::Clearance clearance(Arm("planar2"), false, {});
  clearance.SetBodies({BoxAt({0.1, 0.1, 0.1}, {0.3, 0.4, 0.0})});
  const Eigen::MatrixXd q = Eigen::MatrixXd::Zero(2, BatchClearance::kLanes);
  clearance.MoveTo(q.col(0));
  const double distance = clearance.Nearest().distance;
  ASSERT_GT(distance, 0.1);
  BatchClearance batch(clearance);
  EXPECT_EQ(batch.Clear(q, 3, distance - 1e-9), 7u);
  EXPECT_EQ(batch.Clear(q, 3, distance + 1e-9), 0u);
  EXPECT_EQ(batch.looked_at(), 6);
  EXPECT_EQ(batch.undecided(), 6);
  EXPECT_EQ(batch.Clear(q, 8, 0.5 * distance), 0xffu);
  EXPECT_EQ(batch.undecided(), 6);  // the balls decide that
}

TEST(BatchClearanceBoundaryTest, WhatIsIgnoredIsNotLookedAt) {
  robot::Clearance clearance(Arm("planar2"), false, {BoxAt({2.0, 2.0, 2.0}, {0.5, 0.0, 0.0})});
  const Eigen::MatrixXd q = Eigen::MatrixXd::Zero(2, BatchClearance::kLanes);
  EXPECT_EQ(BatchClearance(clearance).Clear(q, 1, 0.0), 0u);
  for (const robot::LinkCollider& link : clearance.links()) clearance.Ignore(link.number, 0);
  EXPECT_EQ(BatchClearance(clearance).Clear(q, 1, 0.0), 1u);
}

TEST(BatchClearanceBoundaryTest, NumbersThatAreNotFiniteAreNotClear) {
  robot::Clearance clearance(Arm("planar2"), false, {BoxAt({0.1, 0.1, 0.1}, {0.0, 3.0, 0.0})});
  BatchClearance batch(clearance);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(2, BatchClearance::kLanes);
  q(0, 1) = std::numeric_limits<double>::quiet_NaN();
  q(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(batch.Clear(q, 4, 0.0), 0b1001u);
}

TEST(BatchClearanceBoundaryTest, TurnsCountAsTheirRest) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  BatchClearance batch(clearance);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(2, BatchClearance::kLanes);
  q.row(0).setConstant(std::numbers::pi / 4.0);  // into the post
  q(0, 1) += 200.0 * std::numbers::pi;
  q(0, 2) = 200.0 * std::numbers::pi;
  EXPECT_EQ(batch.Clear(q, 3, 0.0), 0b100u);
}

TEST(BatchClearanceBoundaryTest, SamplesAreAllOfAMotionButItsStart) {
  robot::Clearance clearance(Arm("planar2"), false, test::Post());
  BatchClearance batch(clearance);
  const Eigen::Vector2d x(0.0, 0.0), y(std::numbers::pi / 2.0, 0.0);
  const Eigen::Vector2d post(std::numbers::pi / 4.0, 0.0);
  EXPECT_FALSE(batch.SamplesClear(x, y, 20, 0.0));
  EXPECT_TRUE(batch.SamplesClear(x, y, 1, 0.0));  // one sample is the end
  EXPECT_FALSE(batch.SamplesClear(x, y, 2, 0.0));
  EXPECT_TRUE(batch.SamplesClear(post, y, 1, 0.0));
  EXPECT_EQ(batch.SamplesClear(x, y, 17, 0.0), false);
}

}  // namespace batch_clearance_test
}  // namespace oca::planning
