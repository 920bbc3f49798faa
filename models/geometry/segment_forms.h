// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Sine of the angle below which two directions count as parallel, squared.
inline constexpr double kParallel2 = 1e-28;

/// Segment centre + s direction, |s| <= half; `direction` unit.
struct Segment {
  Eigen::Vector3d centre, direction;
  double half;

  Eigen::Vector3d At(double s) const { return centre + s * direction; }
};

struct SegmentParameters {
  double a, b;
};

/// Where two segments are nearest; of parallel ones the middle of what they have in common.
/// source Ericson 2005, 5.1.9
SegmentParameters NearestOfSegments(const Segment& a, const Segment& b);

/// Signed distance of two segments; crossing ones are 0 apart, and the normal is across both.
CoreDistance SegmentToSegment(const Segment& a, const Segment& b);

/// Signed distance of a box about the origin (A) and a segment (B), in the frame of the box.
///
/// Apart: the square of the distance along the segment is convex and piecewise quadratic, so its
/// minimum lies in the one interval where the slope changes its sign. In overlap: the shortest of
/// the ways out across a face or across an edge and the segment.
CoreDistance BoxToSegment(const Eigen::Vector3d& half, const Segment& segment);

}  // namespace oca::geometry::internal
