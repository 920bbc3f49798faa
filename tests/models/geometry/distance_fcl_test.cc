// SPDX-License-Identifier: BSD-3-Clause
// Separated pairs against FCL 0.7. Its penetration search aborts on ordinary overlaps: left out.
#include <fcl/fcl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/models/geometry/random_bodies.h"
#include "tests/sanitized.h"

namespace oca::geometry {
namespace distance_fcl_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::shared_ptr<fcl::CollisionGeometryd> ToFcl(const ConvexHull& hull) {
  auto vertices = std::make_shared<std::vector<Vector3d>>(hull.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (const auto& t : hull.triangles) faces->insert(faces->end(), {3, t[0], t[1], t[2]});
  return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(hull.triangles.size()), faces);
}

struct ToFclVisitor {
  using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
  Geometry operator()(const Sphere& s) const { return std::make_shared<fcl::Sphered>(s.radius); }
  Geometry operator()(const Box& s) const { return std::make_shared<fcl::Boxd>(s.size); }
  Geometry operator()(const Cylinder& s) const {
    return std::make_shared<fcl::Cylinderd>(s.radius, s.length);
  }
  Geometry operator()(const Capsule& s) const {
    return std::make_shared<fcl::Capsuled>(s.radius, s.length);
  }
  Geometry operator()(const ConvexMesh& s) const { return ToFcl(*s.hull); }
  Geometry operator()(const Cone& s) const {
    return std::make_shared<fcl::Coned>(s.radius, s.length);
  }
  Geometry operator()(const Ellipsoid& s) const {
    return std::make_shared<fcl::Ellipsoidd>(s.radii);
  }
  Geometry operator()(const HalfSpace&) const { return nullptr; }
  Geometry operator()(const Compound&) const { return nullptr; }
};

double FclDistance(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                   const Isometry3d& X_WB) {
  const fcl::CollisionObjectd first(std::visit(ToFclVisitor(), a.shape()), X_WA);
  const fcl::CollisionObjectd second(std::visit(ToFclVisitor(), b.shape()), X_WB);
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.distance_tolerance = 1e-10;
  fcl::DistanceResultd result;
  return fcl::distance(&first, &second, request, result);
}

constexpr int kShares = 4, kPairs = Fewer(125'000);  // a share

class DistanceFclTest : public testing::TestWithParam<int> {};

TEST_P(DistanceFclTest, SeparatedPairsOfAllKindsAgree) {
  RandomBodies random(41 + GetParam());
  std::vector<double> errors;
  for (int i = 0; i < kPairs; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WA = random.Pose(0.8), X_WB = random.Pose(0.8);
    const auto ours = Distance(*a, X_WA, *b, X_WB);
    if (ours.distance < 1e-3) continue;
    errors.push_back(std::abs(FclDistance(*a, X_WA, *b, X_WB) - ours.distance));
  }
  std::sort(errors.begin(), errors.end());
  ASSERT_GT(errors.size(), kPairs / 2u);
  EXPECT_LE(errors[errors.size() / 2], 1e-9);
  EXPECT_LE(errors[errors.size() * 99 / 100], 1e-6);
  EXPECT_LE(errors.back(), 1e-4);  // FCL's stopping rule on curved pairs, see distance_proof_test
}

INSTANTIATE_TEST_SUITE_P(Shares, DistanceFclTest, testing::Range(0, kShares));

}  // namespace distance_fcl_test
}  // namespace oca::geometry
