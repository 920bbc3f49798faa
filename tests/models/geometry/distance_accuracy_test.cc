// SPDX-License-Identifier: BSD-3-Clause
// A million pairs of all kinds at gaps from 1 m through touch to 0.1 m deep. A plane across the
// normal proves each distance from below; the nearest points, which formulas of their own place in
// the bodies, prove it from above. Where bodies were moved along the normal the gap is known too.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <vector>

#include "oca/models/geometry/core_forms.h"
#include "tests/models/geometry/random_bodies.h"
#include "tests/sanitized.h"

namespace oca::geometry {
namespace distance_accuracy_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kShares = 8;
constexpr int kQueries = Fewer(1'000'000) / kShares / 4 * 4;
constexpr int kBodiesAKind = 6;
constexpr std::array kGaps{1.0, 0.1,   1e-2,  1e-4,  1e-6,  1e-8, 1e-10,
                           0.0, -1e-8, -1e-6, -1e-4, -1e-2, -0.1};

// How far a point lies outside a body, m.
double OutsideBody(const Collider& body, const Isometry3d& X, const Vector3d& p) {
  const Vector3d local = X.linear().transpose() * (p - X.translation());
  return internal::OutsideOf(body, local).distance - body.radius();
}

// Round sides that no formula covers: cylinder, cone, ellipsoid against anything but a sphere.
bool IsSearched(const Collider& a, const Collider& b) {
  const auto round = [](const Collider& body) {
    return body.core() >= Collider::Core::kCylinder && body.core() <= Collider::Core::kEllipsoid;
  };
  const bool sphere = a.core() == Collider::Core::kPoint || b.core() == Collider::Core::kPoint;
  return (round(a) || round(b)) && !sphere;
}

struct Worst {
  double apart{0.0};    // of the proved bounds or the known gap, m
  double overlap{0.0};  // the same where distance < 0
  double normal{0.0};   // against the direction of the move, rad, gaps of 1e-4 m and more
  int count{0};

  void Add(double error, bool inside) {
    double& worst = inside ? overlap : apart;
    worst = std::max(worst, error);
  }
};

struct Tally {
  Worst flat, round;
  int open{0};             // proof not closed: a ring of equally short exits
  double open_worst{0.0};  // m, of these
  int wrong_sign{0};
};

void Judge(const Collider& a, const Isometry3d& X_WA, const Collider& b, const Isometry3d& X_WB,
           double gap, const SignedDistance& before, Tally* tally) {
  const auto found = Distance(a, X_WA, b, X_WB);
  const bool searched = IsSearched(a, b);
  Worst open;
  const bool proved = found.status == DistanceStatus::kExact;
  tally->open += !proved;
  Worst& worst = searched ? proved ? tally->round : open : tally->flat;
  ++(searched ? tally->round : tally->flat).count;
  const bool inside = found.distance < 0.0;
  // From below, and from above. In overlap: the translation along the normal separates. A normal
  // that is the direction of a short vector has few digits, and so has the plane across it.
  const double width = SlabWidth(a, X_WA, b, X_WB, found.normal);
  const double rounding = found.distance > 0.0 ? 4e-15 / found.distance : 0.0;
  worst.Add(std::abs(width - found.distance) - rounding, inside);
  // Where bodies all but touch, the nearest points come from a sliver, whose weights are rounded.
  const double sliver = std::abs(found.distance) < 1e-7 ? 1e-10 : 0.0;
  worst.Add(OutsideBody(a, X_WA, found.point_a) - sliver, inside);
  worst.Add(OutsideBody(b, X_WB, found.point_b) - sliver, inside);
  worst.Add((found.point_a - found.point_b - found.distance * found.normal).norm(), inside);
  tally->open_worst = std::max({tally->open_worst, open.apart, open.overlap});
  if (gap < 0.0) return;
  worst.Add(std::abs(found.distance - gap), false);
  tally->wrong_sign += found.distance < 0.0 && gap > (searched ? 1e-7 : 1e-12);
  if (gap < 1e-4) return;
  worst.normal = std::max(worst.normal, found.normal.cross(before.normal).norm());
}

class DistanceAccuracyTest : public testing::TestWithParam<int> {};

TEST_P(DistanceAccuracyTest, PairsOfAllKindsAtAllGapsAreProvedFromBothSides) {
  RandomBodies random(100 + GetParam());
  std::vector<std::shared_ptr<const Collider>> bodies;
  for (int i = 0; i < RandomBodies::kKinds * kBodiesAKind; ++i) {
    bodies.push_back(random.Body(i % RandomBodies::kKinds));
  }
  const int count = static_cast<int>(bodies.size());
  Tally tally;
  for (int i = 0; i < kQueries; i += 4) {
    const Collider &a = *bodies[random.Integer(count)], &b = *bodies[random.Integer(count)];
    Isometry3d X_WA = random.Pose(0.4);
    const Isometry3d X_WB = random.Pose(0.4);
    const auto before = Distance(a, X_WA, b, X_WB);
    const Vector3d place = X_WA.translation() - before.distance * before.normal;
    for (int k = 0; k < 4; ++k) {
      const double gap = kGaps[random.Integer(static_cast<int>(kGaps.size()))];
      X_WA.translation() = place + gap * before.normal;
      Judge(a, X_WA, b, X_WB, gap, before, &tally);
    }
  }
  std::cout << "flat or closed: " << tally.flat.apart << " m apart, " << tally.flat.overlap
            << " m in overlap, normal " << tally.flat.normal << " rad, " << tally.flat.count
            << " pairs; round: " << tally.round.apart << " m, " << tally.round.overlap << " m, "
            << tally.round.normal << " rad, " << tally.round.count << " pairs; " << tally.open
            << " open, " << tally.open_worst << " m\n";
  EXPECT_EQ(tally.flat.count + tally.round.count, kQueries);
  EXPECT_GT(tally.round.count, kQueries / 4);
  EXPECT_EQ(tally.wrong_sign, 0);
  EXPECT_LE(tally.open, kQueries / 2'500);
  EXPECT_LE(tally.open_worst, 1e-9);
  EXPECT_LE(tally.flat.apart, 1e-12);
  EXPECT_LE(tally.flat.overlap, 1e-12);
  EXPECT_LE(tally.flat.normal, 1e-6);
  EXPECT_LE(tally.round.apart, 1e-7);
  EXPECT_LE(tally.round.overlap, 1e-6);
  EXPECT_LE(tally.round.normal, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Shares, DistanceAccuracyTest, testing::Range(0, kShares));

// The plane of a face, or across an edge of either, that the origin of A - B is least below.
double EnumeratedDepth(const ConvexHull& a, const Isometry3d& X_WA, const ConvexHull& b,
                       const Isometry3d& X_WB) {
  std::vector<Vector3d> directions;
  std::array<std::vector<Vector3d>, 2> edges;
  const auto collect = [&](const ConvexHull& hull, const Isometry3d& X,
                           std::vector<Vector3d>* out) {
    for (const auto& [i, j, k] : hull.triangles) {
      const Vector3d &p = hull.vertices[i], &q = hull.vertices[j], &r = hull.vertices[k];
      directions.push_back(X.linear() * (q - p).cross(r - p));
      if (i < j) out->push_back(X.linear() * (q - p));
      if (j < k) out->push_back(X.linear() * (r - q));
      if (k < i) out->push_back(X.linear() * (p - r));
    }
  };
  collect(a, X_WA, &edges[0]);
  collect(b, X_WB, &edges[1]);
  for (const Vector3d& u : edges[0]) {
    for (const Vector3d& v : edges[1]) directions.push_back(u.cross(v));
  }
  const auto reach = [](const ConvexHull& hull, const Isometry3d& X, const Vector3d& n) {
    double most = -1e300;
    for (const Vector3d& p : hull.vertices) most = std::max(most, n.dot(X * p));
    return most;
  };
  double least = 1e300;
  for (const Vector3d& direction : directions) {
    if (direction.norm() < 1e-9) continue;
    for (const Vector3d& n :
         {Vector3d(direction.normalized()), Vector3d(-direction.normalized())}) {
      least = std::min(least, reach(a, X_WA, n) + reach(b, X_WB, -n));
    }
  }
  return least;
}

std::shared_ptr<const ConvexHull> BoxHull(const Vector3d& size) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(0.5 *
                      size.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  return MakeConvexHull(corners, "box");
}

// A box twice: its own formulas, and a mesh of the same corners through the search.
TEST(DistanceEnumerationTest, OverlapsOfSmallPolyhedraAreThoseOfEveryFaceAndEdgePair) {
  RandomBodies random(201);
  double worst = 0.0;
  int overlaps = 0;
  for (int i = 0; i < Fewer(20'000); ++i) {
    const Shape shape_a = random.RandomShape(2), shape_b = random.RandomShape(2);
    const auto hull_a = BoxHull(std::get<Box>(shape_a).size);
    const auto hull_b = BoxHull(std::get<Box>(shape_b).size);
    const Isometry3d X_WA = random.Pose(0.15), X_WB = random.Pose(0.15);
    const auto box_a = MakeCollider(shape_a, "a"), box_b = MakeCollider(shape_b, "b");
    const auto mesh_a = MakeCollider(ConvexMesh{hull_a}, "a");
    const double found = Distance(*box_a, X_WA, *box_b, X_WB).distance;
    if (found >= 0.0) continue;
    ++overlaps;
    const double depth = EnumeratedDepth(*hull_a, X_WA, *hull_b, X_WB);
    worst = std::max(worst, std::abs(found + depth));
    worst = std::max(worst, std::abs(Distance(*mesh_a, X_WA, *box_b, X_WB).distance + depth));
  }
  std::cout << overlaps << " overlaps, off by at most " << worst << " m\n";
  EXPECT_GT(overlaps, Fewer(5'000));
  EXPECT_LE(worst, 1e-12);
}

TEST(DistanceEnumerationTest, BoxesApartAreAsFarAsTheirMeshes) {
  RandomBodies random(202);
  double worst = 0.0;
  for (int i = 0; i < Fewer(20'000); ++i) {
    const Shape shape = random.RandomShape(2);
    const auto box = MakeCollider(shape, "a"), other = random.Body(random.Integer(3));
    const auto mesh = MakeCollider(ConvexMesh{BoxHull(std::get<Box>(shape).size)}, "mesh");
    const Isometry3d X_WA = random.Pose(0.3), X_WB = random.Pose(0.3);
    worst = std::max(worst, std::abs(Distance(*box, X_WA, *other, X_WB).distance -
                                     Distance(*mesh, X_WA, *other, X_WB).distance));
  }
  EXPECT_LE(worst, 1e-12);
}

}  // namespace distance_accuracy_test
}  // namespace oca::geometry
