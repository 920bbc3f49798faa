// SPDX-License-Identifier: BSD-3-Clause
#include "models/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/geometry/bullet_penetration.h"
#include "models/geometry/closed_forms.h"
#include "models/geometry/gjk.h"
#include "models/geometry/polytope_depth.h"

namespace oca::models {
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

// What the bounding spheres know. kBeyond if that is enough.
SignedDistance SphereBound(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                           const Isometry3d& X_WB, double max_distance) {
  const Vector3d centre_a = X_WA * a.centre(), centre_b = X_WB * b.centre();
  const Vector3d offset = centre_a - centre_b;
  SignedDistance result;
  const double length = offset.norm();
  result.distance = length - a.bounding_radius() - b.bounding_radius();
  if (!(result.distance > max_distance) || length == 0.0) return result;
  result.normal = offset / length;
  result.point_a = centre_a - a.bounding_radius() * result.normal;
  result.point_b = centre_b + b.bounding_radius() * result.normal;
  result.status = DistanceStatus::kBeyond;
  return result;
}

bool IsCurved(const CorePair& pair) {
  return pair.a.core() == Collider::Core::kCylinder || pair.b.core() == Collider::Core::kCylinder;
}

DistanceStatus StatusOf(const CorePair& pair, const CoreDistance& found) {
  return found.gap <= kExactGap * pair.Extent() ? DistanceStatus::kExact
                                                : DistanceStatus::kApproximate;
}

// Close to touch GJK may stall on a sliver. The plane of a polytope separates better there, or
// gives a start from which GJK takes another way.
void ProveSeparation(const CorePair& pair, CoreDistance* found) {
  CoreDistance plane = internal::PolytopeDepth(pair, -found->normal);
  plane.gap = std::max(found->distance - plane.distance, 0.0);
  if (plane.gap <= kExactGap * pair.Extent()) {
    *found = plane;
    return;
  }
  const CorePair::Difference start = pair.Support(-plane.normal);
  PairCache cache{.count = 1, .points_a = {start.a}, .points_b = {start.b}};
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
  const Vector3d hint = IsCurved(pair) ? internal::BulletExit(pair) : Vector3d(Vector3d::Zero());
  *found = internal::PolytopeDepth(pair, hint);
  if (found->distance > 10.0 * internal::kTouch * pair.Extent()) {
    // A plane between the cores: GJK was misled by a flat simplex and now knows better.
    if (internal::Gjk(pair, std::numeric_limits<double>::infinity(), true, nullptr, found) ==
        GjkStatus::kTouching) {
      return DistanceStatus::kApproximate;
    }
  }
  return StatusOf(pair, *found);
}

DistanceStatus Solve(const CorePair& pair, double max_core_distance, PairCache* cache,
                     CoreDistance* found) {
  if (const auto closed = internal::ClosedForm(pair)) {
    *found = *closed;
    return DistanceStatus::kExact;
  }
  switch (internal::Gjk(pair, max_core_distance, false, cache, found)) {
    case GjkStatus::kBeyond:
      return DistanceStatus::kBeyond;
    case GjkStatus::kSeparated:
      if (found->gap > kExactGap * pair.Extent()) ProveSeparation(pair, found);
      return StatusOf(pair, *found);
    case GjkStatus::kTouching:
      break;
  }
  return Overlap(pair, found);
}

}  // namespace

SignedDistance Distance(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                        const Isometry3d& X_WB, double max_distance, PairCache* cache) {
  if (!X_WA.matrix().allFinite() || !X_WB.matrix().allFinite()) return Invalid();
  SignedDistance result = SphereBound(a, X_WA, b, X_WB, max_distance);
  if (result.status == DistanceStatus::kBeyond) return result;

  // The simpler core goes second: closed forms are written for that order only.
  const bool swapped = a.core() < b.core();
  const Collider& first = swapped ? b : a;
  const Collider& second = swapped ? a : b;
  const Isometry3d& X_WF = swapped ? X_WB : X_WA;
  const Isometry3d& X_WS = swapped ? X_WA : X_WB;
  const CorePair pair{first, second, X_WF.inverse() * X_WS};
  CoreDistance core;
  const double radii = first.radius() + second.radius();
  result.status = Solve(pair, max_distance + radii, cache, &core);
  if (!std::isfinite(core.distance)) return Invalid();

  result.distance = core.distance - radii;
  result.normal = X_WF.linear() * core.normal;
  result.point_a = X_WF * (core.point_a - first.radius() * core.normal);
  result.point_b = X_WF * (core.point_b + second.radius() * core.normal);
  if (swapped) {
    std::swap(result.point_a, result.point_b);
    result.normal = -result.normal;
  }
  return result;
}

}  // namespace oca::models
