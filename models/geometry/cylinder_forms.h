// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/core_pair.h"
#include "oca/models/geometry/segment_forms.h"

namespace oca::geometry::internal {

/// Distance of a cylinder about the z-axis (A, half extents `half`) and a segment (B) apart from
/// it; false if they overlap or all but touch.
///
/// The distance of a point of the segment is convex in its parameter, and between the crossings of
/// the cylinder's side and its two end planes smooth; beside a rim Newton's method finds its least.
bool CylinderToSegment(const Eigen::Vector3d& half, const Segment& segment, CoreDistance* found);

}  // namespace oca::geometry::internal
