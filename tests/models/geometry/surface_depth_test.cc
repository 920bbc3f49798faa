// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/surface_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "oca/models/geometry/gjk.h"
#include "oca/models/geometry/polytope_depth.h"
#include "oca/models/geometry/star_surface.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry::internal {
namespace surface_depth_test {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Corner = StarSurface::Corner;

constexpr double kFar = std::numeric_limits<double>::infinity();

Corner At(const Vector3d& w) { return {w, w, Vector3d::Zero()}; }

// Every other corner of a cube of edge 2; its planes lie 1 / sqrt(3) from the centre.
std::array<Corner, 4> Tetrahedron(const Vector3d& centre = Vector3d::Zero()) {
  return {At(centre + Vector3d(1, 1, 1)), At(centre + Vector3d(1, -1, -1)),
          At(centre + Vector3d(-1, 1, -1)), At(centre + Vector3d(-1, -1, 1))};
}

int Faces(const StarSurface& surface) {
  int faces = 0;
  for (int i = 0; i < surface.face_slots(); ++i) faces += surface.offset(i) < kFar;
  return faces;
}

// Adds a corner above the first face that it lies above.
bool GrowTo(const Vector3d& w, StarSurface* surface) {
  for (int i = 0; i < surface->face_slots(); ++i) {
    if (surface->offset(i) < surface->face(i).normal.dot(w)) return surface->Grow(At(w), i);
  }
  return false;
}

TEST(StarSurfaceTest, ATetrahedronProvesTheBallWithinItsPlanes) {
  StarSurface surface(2.0);
  ASSERT_TRUE(surface.Start(Tetrahedron()));
  EXPECT_NEAR(surface.offset(surface.LowestFace()), 1.0 / std::sqrt(3.0), 1e-15);
  std::array<Corner, 4> mirrored = Tetrahedron();
  std::swap(mirrored[0], mirrored[3]);
  ASSERT_TRUE(surface.Start(mirrored));
  EXPECT_NEAR(surface.offset(surface.LowestFace()), 1.0 / std::sqrt(3.0), 1e-15);
}

TEST(StarSurfaceTest, TheOriginMustBeInsideBeyondDoubt) {
  const auto starts = [](double along) {
    StarSurface surface(4.0);
    return surface.Start(Tetrahedron(along / std::sqrt(3.0) * Vector3d::Ones()));
  };
  EXPECT_TRUE(starts(1.0 / std::sqrt(3.0) - 1e-9));
  EXPECT_FALSE(starts(1.0 / std::sqrt(3.0)));
  EXPECT_FALSE(starts(1.0 / std::sqrt(3.0) + 1e-9));
}

TEST(StarSurfaceTest, GrowsFromATetrahedronToACube) {
  StarSurface surface(4.0);
  ASSERT_TRUE(surface.Start(Tetrahedron()));
  for (const Vector3d& w : {Vector3d(-1, -1, -1), Vector3d(-1, 1, 1), Vector3d(1, -1, 1)}) {
    ASSERT_TRUE(GrowTo(w, &surface));
    EXPECT_LT(surface.offset(surface.LowestFace()), 0.6);
  }
  ASSERT_TRUE(GrowTo(Vector3d(1, 1, -1), &surface));
  EXPECT_NEAR(surface.offset(surface.LowestFace()), 1.0, 1e-15);
  EXPECT_EQ(Faces(surface), 12);
  // A corner in the plane of a side sees the next side alone, and one in an edge's line neither.
  ASSERT_TRUE(GrowTo(Vector3d(1, 3, 0), &surface));
  EXPECT_NEAR(surface.offset(surface.LowestFace()), 1.0, 1e-15);
  EXPECT_EQ(Faces(surface), 14);
}

TEST(StarSurfaceTest, ANeedleIsRefused) {
  const Vector3d w(1.0, 1.5, 1.5);  // on the line of the edge from (1, 1, 1) to (1, -1, -1)
  int beside = 0;
  for (int i = 0; i < 4; ++i) {
    StarSurface surface(4.0);
    ASSERT_TRUE(surface.Start(Tetrahedron()));
    if (std::abs(surface.face(i).normal.dot(w) - surface.offset(i)) > 1e-9) continue;
    ++beside;
    EXPECT_FALSE(surface.Grow(At(w), i));  // the cone would have a face without an area
  }
  EXPECT_EQ(beside, 2);
}

TEST(StarSurfaceTest, WhatIsKeptMovesWithTheBodies) {
  RandomBodies random(61);
  const auto a = random.Body(2), b = random.Body(2);
  CorePair pair{*a, *b, Isometry3d::Identity()};
  std::array<Corner, 4> corners;
  for (int i = 0; i < 4; ++i) corners[i] = pair.Support(Tetrahedron()[i].w);
  StarSurface surface(pair.Extent());
  ASSERT_TRUE(surface.Start(corners));
  ASSERT_TRUE(surface.Grow(pair.Support(surface.face(2).normal), 2));
  PairCache::Surface kept;
  surface.Keep(&kept);
  ASSERT_EQ(kept.corners, 5);
  ASSERT_EQ(kept.faces, 6);

  pair.X_AB.translation().x() += 1e-3;
  StarSurface restored(pair.Extent());
  ASSERT_TRUE(restored.Restore(pair, kept));
  EXPECT_EQ(Faces(restored), 6);
  EXPECT_EQ(restored.corner(0).w, pair.At(restored.corner(0).a, restored.corner(0).b).w);
  ASSERT_TRUE(restored.Grow(pair.Support(restored.face(0).normal), 0));
  pair.X_AB.translation().x() += 2.0 * pair.Extent();
  EXPECT_FALSE(restored.Restore(pair, kept));
}

struct Tally {
  int overlaps{0}, proved{0};
  double off{0.0}, gap{0.0}, plane{0.0};
};

// By the surface where it proves its answer, and by the exact polytope.
void Compare(const CorePair& pair, Tally* tally) {
  Simplex last;
  CoreDistance found;
  if (Gjk(pair, kFar, false, nullptr, &found, &last) != GjkStatus::kTouching) return;
  if (last.count() != 4) return;
  ++tally->overlaps;
  if (!SurfaceDepth(pair, last.points(), nullptr, &found)) return;
  ++tally->proved;
  const CoreDistance exact = PolytopeDepth(pair, Vector3d::Zero());
  tally->off = std::max(tally->off, std::abs(found.distance - exact.distance) - exact.gap);
  tally->gap = std::max(tally->gap, found.gap / pair.Extent());
  const double width = found.normal.dot(pair.Support(-found.normal).w);
  tally->plane = std::max(tally->plane, std::abs(found.distance - width));
}

TEST(SurfaceDepthTest, AgreesWithTheExactPolytopeAndProvesIt) {
  RandomBodies random(62);
  Tally flat, round;
  for (int i = 0; i < 6'000; ++i) {
    const auto a = random.Body(i % 2 == 0 ? 4 : 1 + random.Integer(6)), b = random.Body(i % 5);
    const CorePair pair{*a, *b, random.Pose(0.25)};
    Compare(pair, pair.IsRound() ? &round : &flat);
  }
  EXPECT_GT(flat.overlaps, 500);
  EXPECT_GE(flat.proved, flat.overlaps * 99 / 100);
  EXPECT_LE(flat.off, 1e-12);
  EXPECT_LE(flat.gap, 1e-10);
  EXPECT_LE(flat.plane, 1e-14);
  EXPECT_GT(round.overlaps, 500);
  EXPECT_GE(round.proved, round.overlaps * 9 / 10);
  EXPECT_LE(round.off, 1e-10);
  EXPECT_LE(round.gap, 1e-10);
}

// A hull turns and slides through a box or another hull, a control tick a step.
TEST(SurfaceDepthTest, AKeptSurfaceAnswersAsWellAsAFreshOne) {
  RandomBodies random(63);
  int overlaps = 0, kept = 0;
  for (int run = 0; run < 100; ++run) {
    const auto a = random.Body(4), b = random.Body(run % 2 == 0 ? 2 : 4);
    const Isometry3d X_WB = random.Pose(0.05), X_WA = random.Pose(0.05);
    const Vector3d along = random.Direction(), axis = random.Direction();
    PairCache cache;
    for (int i = -100; i <= 100; ++i) {
      Isometry3d X = X_WA * AngleAxisd(2e-3 * i, axis);
      X.translation() += 1e-3 * i * along;
      PairCache before = cache;
      const SignedDistance warm = Distance(*a, X, *b, X_WB, kFar, &cache);
      const SignedDistance cold = Distance(*a, X, *b, X_WB);
      ASSERT_NEAR(warm.distance, cold.distance, 1e-10);
      ASSERT_EQ(warm.status, cold.status);
      if (cold.distance >= 0.0) continue;
      ASSERT_NEAR(SlabWidth(*a, X, *b, X_WB, warm.normal), warm.distance, 1e-12);
      if (before.surface.corners == 0) continue;
      ++overlaps;
      CoreDistance found;
      kept += KeptSurfaceDepth({*a, *b, X.inverse() * X_WB}, &before, &found);
    }
  }
  EXPECT_GT(overlaps, 10'000);
  EXPECT_GT(kept, overlaps * 3 / 4);
}

}  // namespace surface_depth_test
}  // namespace oca::geometry::internal
