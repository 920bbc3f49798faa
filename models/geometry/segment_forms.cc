// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/segment_forms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

// Below this, relative to the size of the pair, a difference of points carries no direction.
constexpr double kNoDirection = 1e-13;

double NearestTo(const Segment& segment, const Vector3d& p) {
  return std::clamp(segment.direction.dot(p - segment.centre), -segment.half, segment.half);
}

Vector3d Excess(const Vector3d& half, const Vector3d& p) {
  return p - p.cwiseMax(-half).cwiseMin(half);
}

// The parameter of the point of the segment that is nearest to the box.
double NearestToBox(const Vector3d& half, const Segment& s) {
  const auto slope = [&](double at) { return s.direction.dot(Excess(half, s.At(at))); };
  double low = -s.half, high = s.half;
  if (slope(low) >= 0.0) return low;
  if (slope(high) <= 0.0) return high;
  double flat_low = high, flat_high = low;
  for (int i = 0; i < 3; ++i) {
    if (s.direction[i] == 0.0) continue;
    const double inverse = 1.0 / s.direction[i];
    for (const double side : {-half[i], half[i]}) {
      const double at = (side - s.centre[i]) * inverse;
      if (!(at > low && at < high)) continue;
      const double here = slope(at);
      if (here < 0.0) {
        low = at;
      } else if (here > 0.0) {
        high = at;
      } else {
        flat_low = std::min(flat_low, at), flat_high = std::max(flat_high, at);
      }
    }
  }
  if (flat_low <= flat_high) return 0.5 * (flat_low + flat_high);
  // No side changes between low and high: the excess is linear there.
  const Vector3d middle = Excess(half, s.At(0.5 * (low + high)));
  double moving = 0.0, slope_at_middle = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (middle[i] == 0.0) continue;
    moving += s.direction[i] * s.direction[i];
    slope_at_middle += s.direction[i] * middle[i];
  }
  if (!(moving > 0.0)) return 0.5 * (low + high);
  return std::clamp(0.5 * (low + high) - slope_at_middle / moving, low, high);
}

// The part of the segment between the faces of the box across the other axes than `axis`.
SegmentParameters Clip(const Vector3d& half, const Segment& s, int axis) {
  double low = -s.half, high = s.half;
  for (int i = 0; i < 3; ++i) {
    if (i == axis || s.direction[i] == 0.0) continue;
    const double one = (-half[i] - s.centre[i]) / s.direction[i];
    const double two = (half[i] - s.centre[i]) / s.direction[i];
    low = std::max(low, std::min(one, two));
    high = std::min(high, std::max(one, two));
  }
  return {low, high};
}

struct SegmentExit {
  Vector3d normal;  // outward of the box
  double depth;
  int axis;   // of the face, or of the edge
  bool edge;  // across an edge and the segment
};

SegmentExit ShortestExit(const Vector3d& half, const Segment& s) {
  SegmentExit best{Vector3d::UnitZ(), 0.0, -1, false};
  const double slack = 1e-14 * (half.sum() + s.half);
  const auto consider = [&](const Vector3d& axis_normal, int axis, bool edge) {
    const double centre = axis_normal.dot(s.centre);
    const double depth = half.dot(axis_normal.cwiseAbs()) +
                         s.half * std::abs(axis_normal.dot(s.direction)) - std::abs(centre);
    // Where an edge's normal coincides with a face's, the face knows where they touch.
    if (best.axis >= 0 && depth >= best.depth - (edge ? slack : 0.0)) return;
    best = {centre < 0.0 ? Vector3d(-axis_normal) : axis_normal, depth, axis, edge};
  };
  for (int i = 0; i < 3; ++i) consider(Vector3d::Unit(i), i, false);
  for (int i = 0; i < 3; ++i) {
    const Vector3d across = Vector3d::Unit(i).cross(s.direction);
    const double sine2 = across.squaredNorm();
    if (sine2 > kParallel2) consider(across / std::sqrt(sine2), i, true);
  }
  return best;
}

// The box's edge along `axis` that lies farthest along `normal`.
Segment EdgeAlong(const Vector3d& half, const Vector3d& normal, int axis) {
  Segment edge{Vector3d::Zero(), Vector3d::Unit(axis), half[axis]};
  for (int i = 0; i < 3; ++i) {
    if (i != axis) edge.centre[i] = std::copysign(half[i], normal[i]);
  }
  return edge;
}

CoreDistance Overlap(const Vector3d& half, const Segment& s) {
  const SegmentExit exit = ShortestExit(half, s);
  double at = 0.0;
  if (exit.edge) {
    at = NearestOfSegments(EdgeAlong(half, exit.normal, exit.axis), s).b;
  } else {
    const double inward = -exit.normal.dot(s.direction);
    const auto [low, high] = Clip(half, s, exit.axis);
    at = std::abs(inward) * s.half > kNoDirection * half.sum() ? std::copysign(s.half, inward)
                                                               : 0.5 * (low + high);
  }
  CoreDistance result{.distance = -exit.depth, .normal = -exit.normal};
  result.point_b = s.At(at);
  result.point_a = result.point_b + exit.depth * exit.normal;
  return result;
}

}  // namespace

SegmentParameters NearestOfSegments(const Segment& a, const Segment& b) {
  const Vector3d offset = b.centre - a.centre;
  const double along = a.direction.dot(b.direction);
  const Vector3d across = a.direction.cross(b.direction);
  const double sine2 = across.squaredNorm();
  const double offset_a = a.direction.dot(offset), offset_b = b.direction.dot(offset);
  if (sine2 < kParallel2) {
    const double low = std::max(-a.half, offset_a - b.half);
    const double high = std::min(a.half, offset_a + b.half);
    const double s = std::clamp(0.5 * (low + high), -a.half, a.half);
    return {s, NearestTo(b, a.At(s))};
  }
  // The lines first; then back into the segments, one after the other. The cross product keeps the
  // digits that offset_a - along * offset_b loses where the lines are nearly parallel.
  const double free = across.dot(offset.cross(b.direction)) / sine2;
  const double s = std::clamp(free, -a.half, a.half);
  const double t = along * s - offset_b;
  if (std::abs(t) <= b.half) return {s, t};
  const double end = std::copysign(b.half, t);
  return {std::clamp(along * end + offset_a, -a.half, a.half), end};
}

CoreDistance SegmentToSegment(const Segment& a, const Segment& b) {
  const SegmentParameters at = NearestOfSegments(a, b);
  CoreDistance result{.point_a = a.At(at.a), .point_b = b.At(at.b)};
  const Vector3d gap = result.point_a - result.point_b;
  result.distance = gap.norm();
  if (result.distance > kNoDirection * (a.half + b.half)) {
    result.normal = gap / result.distance;
    return result;
  }
  // The axes cross: the shortest way apart is across both.
  const Vector3d across = a.direction.cross(b.direction);
  result.normal =
      across.squaredNorm() > kParallel2 ? across.normalized() : a.direction.unitOrthogonal();
  const Vector3d side = gap.isZero(0.0) ? Vector3d(a.centre - b.centre) : gap;
  if (result.normal.dot(side) < 0.0) result.normal = -result.normal;
  return result;
}

CoreDistance BoxToSegment(const Vector3d& half, const Segment& segment) {
  const double at = NearestToBox(half, segment);
  const Vector3d on_segment = segment.At(at);
  const Vector3d gap = Excess(half, on_segment);
  const double distance = gap.norm();
  if (!(distance > kNoDirection * (half.sum() + segment.half))) return Overlap(half, segment);
  CoreDistance result{.distance = distance, .normal = -gap / distance};
  result.point_b = on_segment;
  result.point_a = on_segment - gap;
  return result;
}

}  // namespace oca::geometry::internal
