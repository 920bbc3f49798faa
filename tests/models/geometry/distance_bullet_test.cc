// SPDX-License-Identifier: BSD-3-Clause
// Against Bullet's own pair detector, apart and in overlap. Now and then it is off by centimetres;
// there the support function decides: no direction of its own may separate more than ours.
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/models/geometry/random_bodies.h"
#include "tests/sanitized.h"

namespace oca::geometry {
namespace distance_bullet_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

static_assert(sizeof(btScalar) == 8);

btVector3 ToBullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

btTransform ToBullet(const Isometry3d& X) {
  btTransform result;
  for (int i = 0; i < 3; ++i) result.getBasis()[i] = ToBullet(Vector3d(X.linear().row(i)));
  result.setOrigin(ToBullet(Vector3d(X.translation())));
  return result;
}

struct ToBulletVisitor {
  using Convex = std::unique_ptr<btConvexShape>;
  Convex operator()(const Sphere& s) const { return std::make_unique<btSphereShape>(s.radius); }
  Convex operator()(const Box& s) const {
    return NoMargin(std::make_unique<btBoxShape>(ToBullet(Vector3d(0.5 * s.size))));
  }
  Convex operator()(const Cylinder& s) const {
    return NoMargin(
        std::make_unique<btCylinderShapeZ>(btVector3(s.radius, s.radius, 0.5 * s.length)));
  }
  Convex operator()(const Capsule& s) const {
    return std::make_unique<btCapsuleShapeZ>(s.radius, s.length);
  }
  Convex operator()(const ConvexMesh& s) const {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vector3d& p : s.hull->vertices) hull->addPoint(ToBullet(p), false);
    hull->recalcLocalAabb();
    return NoMargin(std::move(hull));
  }
  Convex operator()(const auto&) const { return nullptr; }  // Bullet has no peer of the others
  static Convex NoMargin(Convex shape) {
    shape->setMargin(0.0);
    return shape;
  }
};

struct BulletAnswer {
  double distance;
  Vector3d normal;  // from B to A
};

BulletAnswer BulletDistance(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                            const Isometry3d& X_WB) {
  const auto first = std::visit(ToBulletVisitor(), a.shape());
  const auto second = std::visit(ToBulletVisitor(), b.shape());
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver penetration;
  btGjkPairDetector detector(first.get(), second.get(), &simplex, &penetration);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = ToBullet(X_WA);
  input.m_transformB = ToBullet(X_WB);
  btPointCollector output;
  detector.getClosestPoints(input, output, nullptr);
  if (!output.m_hasResult) return {std::nan(""), Vector3d::Zero()};
  const btVector3& n = output.m_normalOnBInWorld;
  return {output.m_distance, Vector3d(n.x(), n.y(), n.z())};
}

constexpr int kShares = 4, kPairs = Fewer(125'000);  // a share

class DistanceBulletTest : public testing::TestWithParam<int> {};

TEST_P(DistanceBulletTest, PairsOfAllKindsAgreeApartAndInOverlap) {
  RandomBodies random(42 + GetParam());
  std::vector<double> errors;
  int overlaps = 0;
  for (int i = 0; i < kPairs; ++i) {
    const auto a = random.Body(random.Integer(5)), b = random.Body(random.Integer(5));
    const Isometry3d X_WA = random.Pose(0.3), X_WB = random.Pose(0.3);
    const auto result = Distance(*a, X_WA, *b, X_WB);
    const double ours = result.distance;
    const auto [theirs, normal] = BulletDistance(*a, X_WA, *b, X_WB);
    if (std::isnan(theirs)) continue;
    errors.push_back(std::abs(theirs - ours));
    overlaps += ours < 0.0;
    ASSERT_NEAR(SlabWidth(*a, X_WA, *b, X_WB, result.normal), ours, 1e-8);
    ASSERT_LE(SlabWidth(*a, X_WA, *b, X_WB, normal.normalized()), ours + 1e-9)
        << KindName(*a) << " and " << KindName(*b);
  }
  std::sort(errors.begin(), errors.end());
  ASSERT_GT(errors.size(), kPairs * 39u / 40u);
  ASSERT_GT(overlaps, kPairs / 4);
  EXPECT_LE(errors[errors.size() / 2], 1e-12);
  EXPECT_LE(errors[errors.size() * 9 / 10], 1e-8);
  EXPECT_LE(errors[errors.size() * 99 / 100], 1e-5);  // the rest are Bullet's: see the slabs above
}

INSTANTIATE_TEST_SUITE_P(Shares, DistanceBulletTest, testing::Range(0, kShares));

}  // namespace distance_bullet_test
}  // namespace oca::geometry
