// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oca/models/geometry/bullet_penetration.h"
#include "oca/models/geometry/closed_forms.h"
#include "oca/models/geometry/core_forms.h"
#include "oca/models/geometry/gjk.h"
#include "oca/models/geometry/nearest_part.h"
#include "oca/models/geometry/polytope_depth.h"
#include "oca/models/geometry/segment_forms.h"
#include "oca/models/geometry/surface_depth.h"

namespace oca::geometry {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using internal::CoreDistance;
using internal::CorePair;
using internal::GjkStatus;

// Bounds that differ by less, relative to the size of the pair, count as proof.
constexpr double kExactGap = 1e-9;

SignedDistance Invalid() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Vector3d nan = Vector3d::Constant(kNaN);
  return {kNaN, nan, nan, nan, DistanceStatus::kInvalid};
}

DistanceStatus StatusOf(const CorePair& pair, const CoreDistance& found) {
  return found.gap <= kExactGap * pair.Extent() ? DistanceStatus::kExact
                                                : DistanceStatus::kApproximate;
}

// Close to touch GJK may stall on a sliver. The plane of a polytope separates better there, or
// gives a start from which GJK takes another way.
void ProveSeparation(const CorePair& pair, CoreDistance* found) {
  CoreDistance plane = internal::PolytopeDepth(pair, -found->normal);
  if (plane.distance <= 0.0 && plane.gap <= kExactGap * pair.Extent()) {  // an overlap after all
    *found = plane;
    return;
  }
  plane.gap = std::max(found->distance - plane.distance, 0.0);
  if (plane.gap <= kExactGap * pair.Extent()) {
    if (pair.IsRound()) {
      *found = plane;
    } else {
      found->gap = plane.gap;  // the points of polyhedra are right to more digits than the plane
    }
    return;
  }
  const CorePair::Difference start = pair.Support(-plane.normal);
  PairCache cache;
  cache.count = 1;
  cache.points_a[0] = start.a;
  cache.points_b[0] = start.b;
  CoreDistance again;
  const auto status =
      internal::Gjk(pair, std::numeric_limits<double>::infinity(), true, &cache, &again);
  if (status == GjkStatus::kTouching) {  // so the plane is all there is to know
    plane.gap = std::max(internal::kTouch * pair.Extent() - plane.distance, 0.0);
    again = plane;
  }
  if (again.gap < found->gap) *found = again;
}

// Cores that overlap, or are closer than a difference vector can tell.
DistanceStatus Overlap(const CorePair& pair, CoreDistance* found) {
  *found = internal::PolytopeDepth(pair, Vector3d::Zero());
  if (!(found->gap <= kExactGap * pair.Extent())) {
    // A ring of equally short exits uses the polytope up; Bullet's answer may be the better start.
    const CoreDistance again = internal::PolytopeDepth(pair, internal::BulletExit(pair));
    if (!(again.gap >= found->gap)) *found = again;
  }
  if (found->distance > 10.0 * internal::kTouch * pair.Extent()) {
    // A plane between the cores: GJK was misled by a flat simplex and now knows better.
    if (internal::Gjk(pair, std::numeric_limits<double>::infinity(), true, nullptr, found) ==
        GjkStatus::kTouching) {
      return DistanceStatus::kApproximate;
    }
  }
  return StatusOf(pair, *found);
}

DistanceStatus Search(const CorePair& pair, double max_core_distance, PairCache* cache,
                      CoreDistance* found) {
  if (cache && cache->surface.corners > 0 && internal::KeptSurfaceDepth(pair, cache, found)) {
    return StatusOf(pair, *found);
  }
  internal::Simplex last;
  switch (internal::Gjk(pair, max_core_distance, false, cache, found, &last)) {
    case GjkStatus::kBeyond:
      return DistanceStatus::kBeyond;
    case GjkStatus::kSeparated:
      if (found->gap > kExactGap * pair.Extent()) ProveSeparation(pair, found);
      return StatusOf(pair, *found);
    case GjkStatus::kTouching:
      break;
  }
  if (internal::ClosedOverlap(pair, found)) return DistanceStatus::kExact;
  if (last.count() == 4 && internal::SurfaceDepth(pair, last.points(), cache, found)) {
    return StatusOf(pair, *found);
  }
  return Overlap(pair, found);
}

// What the bounding spheres know; false if that is not enough.
bool SpheresAreBeyond(const CorePair& pair, double max_core_distance, CoreDistance* found) {
  const Vector3d centre_b = pair.X_AB * pair.b.centre();
  const Vector3d offset = pair.a.centre() - centre_b;
  const double reach = pair.Extent() + max_core_distance;
  const double squared = offset.squaredNorm();
  if (!(squared > reach * reach)) return false;
  const double length = std::sqrt(squared);
  found->normal = offset / length;
  found->distance = length - pair.Extent();
  found->point_a = pair.a.centre() - pair.a.core_bounding_radius() * found->normal;
  found->point_b = centre_b + pair.b.core_bounding_radius() * found->normal;
  return true;
}

// The last row counts too, (0, 0, 0, 1): whole columns take fewer instructions.
bool Finite(const Isometry3d& X_WA, const Isometry3d& X_WB) {
  const Eigen::Vector4d sum = (X_WA.matrix().col(0) + X_WA.matrix().col(1)) +
                              (X_WA.matrix().col(2) + X_WA.matrix().col(3)) +
                              (X_WB.matrix().col(0) + X_WB.matrix().col(1)) +
                              (X_WB.matrix().col(2) + X_WB.matrix().col(3));
  return std::isfinite(sum.sum());
}

// X_WA^-1 X_WB of rotations.
void SetRelative(const Isometry3d& X_WA, const Isometry3d& X_WB, Isometry3d* X_AB) {
  const auto R_AW = X_WA.linear().transpose();
  X_AB->linear().noalias() = R_AW.lazyProduct(X_WB.linear());
  X_AB->translation().noalias() = R_AW.lazyProduct(X_WB.translation() - X_WA.translation());
}

SignedDistance ToWorld(const Isometry3d& X_WA, double radius_a, double radius_b,
                       const CoreDistance& core, DistanceStatus status) {
  const double distance = core.distance - (radius_a + radius_b);
  const Vector3d normal = X_WA.linear() * core.normal;
  const Vector3d point_a = X_WA * (core.point_a - radius_a * core.normal);
  return {distance, point_a, point_a - distance * normal, normal, status};
}

SignedDistance OfSpheres(double radius_a, const Vector3d& centre_a, double radius_b,
                         const Vector3d& centre_b) {
  const Vector3d offset = centre_a - centre_b;
  const double length = offset.norm();
  const Vector3d normal = length > 0.0 ? Vector3d(offset / length) : Vector3d(Vector3d::UnitZ());
  return {length - (radius_a + radius_b), centre_a - radius_a * normal,
          centre_b + radius_b * normal, normal, DistanceStatus::kExact};
}

// In world axes about A's centre: no pose is undone, and no digit lost far from the origin.
SignedDistance OfCapsules(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                          const Isometry3d& X_WB) {
  const CoreDistance core = internal::SegmentToSegment(
      {Vector3d::Zero(), X_WA.linear().col(2), a.half().z()},
      {X_WB.translation() - X_WA.translation(), X_WB.linear().col(2), b.half().z()});
  const double distance = core.distance - (a.radius() + b.radius());
  const Vector3d point_a = X_WA.translation() + (core.point_a - a.radius() * core.normal);
  return {distance, point_a, point_a - distance * core.normal, core.normal, DistanceStatus::kExact};
}

// A is not simpler than B: that is the order in which the algorithms know them.
SignedDistance OfConvex(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                        const Isometry3d& X_WB, double max_distance, PairCache* cache) {
  if (a.core() == Collider::Core::kPoint) {
    return OfSpheres(a.radius(), X_WA.translation(), b.radius(), X_WB.translation());
  }
  if (b.core() == Collider::Core::kPoint && a.core() != Collider::Core::kHull) {
    const Vector3d p = X_WA.linear().transpose() * (X_WB.translation() - X_WA.translation());
    const internal::Outside found = internal::OutsideOf(a, p);
    return ToWorld(X_WA, a.radius(), b.radius(), {found.distance, found.nearest, p, -found.normal},
                   DistanceStatus::kExact);
  }
  if (a.core() == Collider::Core::kSegment) return OfCapsules(a, X_WA, b, X_WB);
  CorePair pair{a, b, Isometry3d()};
  SetRelative(X_WA, X_WB, &pair.X_AB);
  CoreDistance core;
  DistanceStatus status = DistanceStatus::kExact;
  if (!internal::ClosedForm(pair, &core)) {
    const double max_core_distance = max_distance + (a.radius() + b.radius());
    if (a.core() == Collider::Core::kHalfSpace) return Invalid();
    status = SpheresAreBeyond(pair, max_core_distance, &core)
                 ? DistanceStatus::kBeyond
                 : Search(pair, max_core_distance, cache, &core);
    if (!std::isfinite(core.distance)) return Invalid();
  }
  return ToWorld(X_WA, a.radius(), b.radius(), core, status);
}

SignedDistance Swapped(SignedDistance found) {
  std::swap(found.point_a, found.point_b);
  found.normal = -found.normal;
  return found;
}

SignedDistance OfPair(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                      const Isometry3d& X_WB, double max_distance, PairCache* cache) {
  SignedDistance found = a.core() < b.core()
                             ? Swapped(OfConvex(b, X_WB, a, X_WA, max_distance, cache))
                             : OfConvex(a, X_WA, b, X_WB, max_distance, cache);
  if (found.distance > max_distance) found.status = DistanceStatus::kBeyond;
  return found;
}

bool IsConvexAndEnds(const Collider& body) {
  return body.core() != Collider::Core::kCompound && body.core() != Collider::Core::kHalfSpace;
}

// The nearest of many parts of B to the parts of A, of which there are fewer, or to A itself.
SignedDistance OfManyParts(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                           const Isometry3d& X_WB, double max_distance) {
  if (IsConvexAndEnds(a)) {
    return internal::DistanceToNearestPart(a, X_WA, b, X_WB, max_distance);
  }
  SignedDistance best;
  best.distance = max_distance;
  best.status = DistanceStatus::kBeyond;
  for (const Collider::Part& part : a.parts()) {
    const auto found =
        internal::DistanceToNearestPart(*part.collider, X_WA * part.X_SP, b, X_WB, best.distance);
    if (found.status == DistanceStatus::kBeyond) continue;
    if (best.status == DistanceStatus::kBeyond || found.distance < best.distance) best = found;
  }
  return best;
}

// Whether OfManyParts answers for A and B in this order.
bool HasManyParts(const Collider& a, const Collider& b) {
  return b.part_balls() != nullptr && a.core() != Collider::Core::kHalfSpace &&
         a.parts().size() <= b.parts().size();
}

// The nearest pair of parts of two bodies that may be compounds. It starts with the pair that was
// nearest last time, so that the others can be left early.
SignedDistance OfParts(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                       const Isometry3d& X_WB, double max_distance, PairCache* cache) {
  const int count_a = std::max<int>(1, static_cast<int>(a.parts().size()));
  const int count_b = std::max<int>(1, static_cast<int>(b.parts().size()));
  const int count = count_a * count_b;
  const int first = cache && cache->parts < count ? cache->parts : 0;
  SignedDistance best;
  int best_index = -1;
  for (int i = 0; i < count; ++i) {
    const int index = i == 0 ? first : i <= first ? i - 1 : i;
    const bool part_a = !a.parts().empty(), part_b = !b.parts().empty();
    const Collider& one = part_a ? *a.parts()[index / count_b].collider : a;
    const Collider& two = part_b ? *b.parts()[index % count_b].collider : b;
    const Isometry3d X_WO = part_a ? X_WA * a.parts()[index / count_b].X_SP : X_WA;
    const Isometry3d X_WT = part_b ? X_WB * b.parts()[index % count_b].X_SP : X_WB;
    const double limit = i == 0 ? max_distance : std::min(max_distance, best.distance);
    SignedDistance found = OfPair(one, X_WO, two, X_WT, limit, i == 0 ? cache : nullptr);
    if (found.status == DistanceStatus::kInvalid) return found;
    if (best_index >= 0 && (found.distance > best.distance ||
                            (found.distance == best.distance && index > best_index))) {
      continue;
    }
    best = found;
    best_index = index;
  }
  if (cache && best_index != first) {
    cache->Clear();
    cache->parts = best_index;
  }
  return best;
}

}  // namespace

SignedDistance Distance(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                        const Isometry3d& X_WB, double max_distance, PairCache* cache) {
  if (!Finite(X_WA, X_WB)) return Invalid();
  if (a.core() != Collider::Core::kCompound && b.core() != Collider::Core::kCompound) {
    return OfPair(a, X_WA, b, X_WB, max_distance, cache);
  }
  if (HasManyParts(a, b)) return OfManyParts(a, X_WA, b, X_WB, max_distance);
  if (HasManyParts(b, a)) return Swapped(OfManyParts(b, X_WB, a, X_WA, max_distance));
  return OfParts(a, X_WA, b, X_WB, max_distance, cache);
}

}  // namespace oca::geometry
