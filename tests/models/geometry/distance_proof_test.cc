// SPDX-License-Identifier: BSD-3-Clause
// Every answer is judged by the support function: a plane proves it from below, the points from
// above. No second implementation is believed.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace distance_proof_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct Tally {
  int queries{0};
  int approximate{0};
  double proof{0.0};                // |distance - width of the slab across the normal|
  double points{0.0};               // |point_a - point_b - distance normal|
  double outside{0.0};              // of a witness point beyond its body, along any direction tried
  double outside_approximate{0.0};  // the same where the proof stayed open: rings of equal exits
  double shallower{0.0};            // a way out of an overlap that is shorter than the reported one
};

// How far p lies outside a body, seen from many directions.
double Excess(const Collider& body, const Isometry3d& X, const Vector3d& p, const Vector3d& normal,
              RandomBodies* random) {
  double excess = -1.0;
  for (int i = 0; i < 20; ++i) {
    const Vector3d d = i == 0 ? normal : i == 1 ? Vector3d(-normal) : random->Direction();
    excess = std::max(excess, d.dot(p - Farthest(body, X, d)));
  }
  return excess;
}

// The best separating direction that a random search with shrinking steps finds.
double SearchedWidth(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                     const Isometry3d& X_WB, RandomBodies* random) {
  Vector3d best = random->Direction();
  double width = SlabWidth(a, X_WA, b, X_WB, best);
  const auto consider = [&](const Vector3d& d) {
    const double w = SlabWidth(a, X_WA, b, X_WB, d);
    if (w > width) width = w, best = d;
    return best == d;
  };
  for (int i = 0; i < 100; ++i) consider(random->Direction());
  for (double step = 0.2; step > 1e-6;) {
    bool better = false;
    for (int i = 0; i < 5; ++i) {
      better |= consider((best + step * random->Direction()).normalized());
    }
    if (!better) step *= 0.6;
  }
  return width;
}

void Judge(const Collider& a, const Isometry3d& X_WA, const Collider& b, const Isometry3d& X_WB,
           double scale, RandomBodies* random, Tally* tally) {
  const auto result = Distance(a, X_WA, b, X_WB);
  const auto names = KindName(a) + " and " + KindName(b);
  ASSERT_TRUE(std::isfinite(result.distance)) << names;
  ASSERT_NEAR(result.normal.norm(), 1.0, 1e-12) << names;
  ++tally->queries;
  tally->approximate += result.status != DistanceStatus::kExact;
  const double width = SlabWidth(a, X_WA, b, X_WB, result.normal);
  tally->proof = std::max(tally->proof, std::abs(result.distance - width) / scale);
  const Vector3d rest = result.point_a - result.point_b - result.distance * result.normal;
  tally->points = std::max(tally->points, rest.norm() / scale);
  const double excess = std::max(Excess(a, X_WA, result.point_a, result.normal, random),
                                 Excess(b, X_WB, result.point_b, result.normal, random));
  double& outside =
      result.status == DistanceStatus::kExact ? tally->outside : tally->outside_approximate;
  outside = std::max(outside, excess / scale);
  if (result.distance < 0.0 && tally->queries % 4 == 0) {
    const double searched = SearchedWidth(a, X_WA, b, X_WB, random);
    tally->shallower = std::max(tally->shallower, (searched - result.distance) / scale);
  }
}

void ExpectProved(const Tally& tally, double proof) {
  EXPECT_LE(tally.proof, proof);
  EXPECT_LE(tally.points, 1e-9);
  EXPECT_LE(tally.outside, 1e-6);
  EXPECT_LE(tally.outside_approximate, 1e-4);
  EXPECT_LE(tally.shallower, 1e-8);
  EXPECT_LE(tally.approximate, tally.queries / 500);
}

class DistanceProofTest : public testing::TestWithParam<double> {};

TEST_P(DistanceProofTest, AnyPairInAnyPose) {
  const double scale = GetParam();
  RandomBodies random(11, scale);
  Tally tally;
  for (int i = 0; i < 10'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    Judge(*a, random.Pose(0.3), *b, random.Pose(0.3), scale, &random, &tally);
  }
  ExpectProved(tally, 1e-9);
}

TEST_P(DistanceProofTest, FacesEdgesAndAxesThatCoincide) {
  const double scale = GetParam();
  RandomBodies random(12, scale);
  Tally tally;
  for (int i = 0; i < 10'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    Judge(*a, random.GridPose(), *b, random.GridPose(), scale, &random, &tally);
  }
  ExpectProved(tally, 1e-7);
}

// From 1 m apart through touch to 0.1 m deep. Close to touch the normal of a vertex contact is the
// direction of a vector of 1e-10 m: its rounding shows in the slab, not in the distance.
TEST_P(DistanceProofTest, ChosenGapsAcrossTouch) {
  const double scale = GetParam();
  RandomBodies random(13, scale);
  Tally tally;
  double placed = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    Isometry3d X_WA = random.Pose(0.3);
    const Isometry3d X_WB = random.Pose(0.3);
    const auto first = Distance(*a, X_WA, *b, X_WB);
    const double gaps[] = {1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 0.0, -1e-8, -1e-6, -1e-4, -0.1};
    const double gap = scale * gaps[random.Integer(12)];
    X_WA.translation() += (gap - first.distance) * first.normal;
    Judge(*a, X_WA, *b, X_WB, scale, &random, &tally);
    // Going out along the normal, and from outside in to touch, the gap is known exactly.
    if (first.distance > 0.0 && gap >= 0.0) {
      const double found = Distance(*a, X_WA, *b, X_WB).distance;
      placed = std::max(placed, std::abs(found - gap) / scale);
    }
  }
  ExpectProved(tally, 1e-6);
  EXPECT_LE(placed, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Scales, DistanceProofTest, testing::Values(1e-6, 1e-3, 1.0, 1e3));

TEST(DistanceProofTest, AWrongAnswerWouldBeNoticed) {
  const auto box = MakeCollider(Box{Eigen::Vector3d::Ones()}, "box");
  const Isometry3d X_WB = Isometry3d::Identity();
  Isometry3d X_WA = X_WB;
  X_WA.translation().x() = 2.0;
  EXPECT_NEAR(SlabWidth(*box, X_WA, *box, X_WB, Vector3d::UnitX()), 1.0, 1e-15);
  const Vector3d skew = Vector3d(1.0, 0.01, 0.0).normalized();
  EXPECT_LT(SlabWidth(*box, X_WA, *box, X_WB, skew), 1.0 - 1e-3);
  EXPECT_LT(SlabWidth(*box, X_WA, *box, X_WB, -Vector3d::UnitX()), -2.9);
}

}  // namespace distance_proof_test
}  // namespace oca::geometry
