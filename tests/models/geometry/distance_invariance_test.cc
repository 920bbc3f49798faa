// SPDX-License-Identifier: BSD-3-Clause
// What must not change when the world moves, the bodies swap, time goes on or a cache is warm.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace distance_invariance_test {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST(DistanceInvarianceTest, MovingTheWorldMovesPointsAndNormal) {
  RandomBodies random(21);
  for (int i = 0; i < 5'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WA = random.Pose(0.4), X_WB = random.Pose(0.4), X_VW = random.Pose(2.0);
    const auto here = Distance(*a, X_WA, *b, X_WB);
    const auto there = Distance(*a, X_VW * X_WA, *b, X_VW * X_WB);
    ASSERT_NEAR(here.distance, there.distance, 1e-9);
    const Vector3d back = X_VW.linear().transpose() * there.normal;
    // Another direction may be as good; then the slab across it is as wide.
    ASSERT_NEAR(SlabWidth(*a, X_WA, *b, X_WB, back), here.distance, 1e-8);
  }
}

TEST(DistanceInvarianceTest, SwappingTheBodiesFlipsTheNormal) {
  RandomBodies random(22);
  for (int i = 0; i < 5'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WA = random.Pose(0.4), X_WB = random.Pose(0.4);
    const auto ab = Distance(*a, X_WA, *b, X_WB);
    const auto ba = Distance(*b, X_WB, *a, X_WA);
    ASSERT_NEAR(ab.distance, ba.distance, 1e-9);
    ASSERT_NEAR(SlabWidth(*a, X_WA, *b, X_WB, -ba.normal), ab.distance, 1e-8);
    if (ab.distance > 1e-3) {
      ASSERT_LT((ab.normal + ba.normal).norm(), 1e-4);
    }
  }
}

// A slides and turns past B, through it and out again. A distance cannot change by more than the
// fastest point of A moved.
TEST(DistanceInvarianceTest, DistanceNeverChangesByMoreThanTheMotion) {
  RandomBodies random(23);
  int signs = 0;
  for (int pair = 0; pair < 100; ++pair) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WB = random.Pose(0.05), X_WA = random.Pose(0.05);
    const Vector3d along = random.Direction(), axis = random.Direction();
    constexpr double kStep = 2e-3, kTurn = 2e-3;
    const double reach = a->centre().norm() + a->bounding_radius();
    double before = 0.0;
    for (int i = -400; i <= 400; ++i) {
      Isometry3d X = X_WA * AngleAxisd(kTurn * i, axis);
      X.translation() += kStep * i * along;
      const double now = Distance(*a, X, *b, X_WB).distance;
      if (i > -400) {
        ASSERT_LE(std::abs(now - before), kStep + kTurn * reach + 1e-8)
            << KindName(*a) << " and " << KindName(*b) << " at step " << i;
        signs += (now > 0) != (before > 0);
      }
      before = now;
    }
  }
  EXPECT_GE(signs, 150);  // the paths do lead through touch
}

TEST(DistanceInvarianceTest, AWarmCacheChangesNothingButTime) {
  RandomBodies random(24);
  for (int pair = 0; pair < 200; ++pair) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WB = random.Pose(0.1), X_WA = random.Pose(0.1);
    const Vector3d along = random.Direction(), axis = random.Direction();
    PairCache cache;
    for (int i = -100; i <= 100; ++i) {
      Isometry3d X = X_WA * AngleAxisd(5e-3 * i, axis);
      X.translation() += 5e-3 * i * along;
      const auto cold = Distance(*a, X, *b, X_WB);
      const auto warm = Distance(*a, X, *b, X_WB, std::numeric_limits<double>::infinity(), &cache);
      ASSERT_NEAR(cold.distance, warm.distance, 2e-9);
      ASSERT_NEAR(SlabWidth(*a, X, *b, X_WB, warm.normal), warm.distance, 1e-7);
    }
  }
}

TEST(DistanceInvarianceTest, ACacheSurvivesAJump) {
  RandomBodies random(25);
  for (int pair = 0; pair < 200; ++pair) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    PairCache cache;
    for (int i = 0; i < 20; ++i) {
      const Isometry3d X_WA = random.Pose(0.5), X_WB = random.Pose(0.5);
      const auto warm =
          Distance(*a, X_WA, *b, X_WB, std::numeric_limits<double>::infinity(), &cache);
      ASSERT_NEAR(warm.distance, Distance(*a, X_WA, *b, X_WB).distance, 2e-9);
    }
  }
}

// What is beyond by the limit is beyond in truth, and nothing nearer is ever left out.
TEST(DistanceInvarianceTest, TheLimitDividesNearFromFar) {
  RandomBodies random(26);
  int beyond = 0, near = 0;
  for (int i = 0; i < 10'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WA = random.Pose(0.6), X_WB = random.Pose(0.6);
    const double limit = 0.1;
    const double full = Distance(*a, X_WA, *b, X_WB).distance;
    const auto cut = Distance(*a, X_WA, *b, X_WB, limit);
    if (cut.status == DistanceStatus::kBeyond) {
      ++beyond;
      ASSERT_GT(cut.distance, limit);
      ASSERT_LE(cut.distance, full + 1e-9);
    } else {
      ++near;
      ASSERT_NEAR(cut.distance, full, 1e-9);
    }
  }
  EXPECT_GT(beyond, 1'000);
  EXPECT_GT(near, 1'000);
}

}  // namespace distance_invariance_test
}  // namespace oca::geometry
