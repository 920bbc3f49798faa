// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/closed_forms.h"

#include "oca/models/geometry/box_overlap.h"
#include "oca/models/geometry/core_forms.h"
#include "oca/models/geometry/cylinder_forms.h"
#include "oca/models/geometry/segment_forms.h"

namespace oca::geometry::internal {
namespace {

using Core = Collider::Core;
using Eigen::Vector3d;

CoreDistance FromOutside(const Outside& outside, const Vector3d& point) {
  return {outside.distance, outside.nearest, point, -outside.normal};
}

// The lowest point of B counts.
CoreDistance HalfSpaceToCore(const CorePair& pair) {
  const Vector3d down = -pair.X_AB.linear().row(2).transpose();
  const Vector3d lowest = pair.X_AB * CoreSupport(pair.b, down);
  return {lowest.z(), {lowest.x(), lowest.y(), 0.0}, lowest, -Vector3d::UnitZ()};
}

Segment SegmentOfB(const CorePair& pair) {
  return {pair.X_AB.translation(), pair.X_AB.linear().col(2), pair.b.half().z()};
}

}  // namespace

bool ClosedForm(const CorePair& pair, CoreDistance* found) {
  const Core a = pair.a.core(), b = pair.b.core();
  if (a == Core::kHalfSpace) {
    if (b >= Core::kHalfSpace) return false;
    *found = HalfSpaceToCore(pair);
  } else if (b == Core::kPoint && a < Core::kHull) {
    const Vector3d p = pair.X_AB.translation();
    *found = FromOutside(OutsideOf(pair.a, p), p);
  } else if (b == Core::kSegment && a == Core::kSegment) {
    *found = SegmentToSegment({Vector3d::Zero(), Vector3d::UnitZ(), pair.a.half().z()},
                              SegmentOfB(pair));
  } else if (b == Core::kSegment && a == Core::kBox) {
    *found = BoxToSegment(pair.a.half(), SegmentOfB(pair));
  } else if (b == Core::kSegment && a == Core::kCylinder) {
    return CylinderToSegment(pair.a.half(), SegmentOfB(pair), found);
  } else {
    return false;
  }
  return true;
}

bool ClosedOverlap(const CorePair& pair, CoreDistance* found) {
  if (pair.a.core() == Core::kBox && pair.b.core() == Core::kBox) {
    *found = BoxOverlap(pair);
    return true;
  }
  if (pair.a.core() == Core::kHull && pair.b.core() == Core::kPoint) {
    const Vector3d p = pair.X_AB.translation();
    *found = FromOutside(OutsideOfHull(*pair.a.hull(), p), p);
    return true;
  }
  return false;
}

}  // namespace oca::geometry::internal
