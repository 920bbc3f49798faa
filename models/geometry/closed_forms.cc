// SPDX-License-Identifier: BSD-3-Clause
#include "models/geometry/closed_forms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace oca::models::internal {
namespace {

using Core = Collider::Core;
using Eigen::Vector3d;

// Below this, relative to the size of the pair, a difference of points carries no direction.
constexpr double kNoDirection = 1e-14;

// A point against A; `normal` is outward of A here.
struct Outside {
  double distance;
  Vector3d nearest;
  Vector3d normal;
};

Outside PointToPoint(const Vector3d& p) {
  const double distance = p.stableNorm();
  return {distance, Vector3d::Zero(),
          distance > 0.0 ? p.stableNormalized().eval() : Vector3d::UnitZ().eval()};
}

Outside PointToSegment(double half, const Vector3d& p) {
  const Vector3d nearest(0.0, 0.0, std::clamp(p.z(), -half, half));
  const Vector3d gap = p - nearest;
  const double distance = gap.stableNorm();
  return {distance, nearest,
          distance > 0.0 ? gap.stableNormalized().eval() : Vector3d::UnitX().eval()};
}

Outside PointToBox(const Vector3d& half, const Vector3d& p) {
  const Vector3d nearest = p.cwiseMax(-half).cwiseMin(half);
  const Vector3d gap = p - nearest;
  const double distance = gap.stableNorm();
  if (distance > 0.0) return {distance, nearest, gap.stableNormalized()};
  int axis = 0;
  const double exit = (half - p.cwiseAbs()).minCoeff(&axis);
  Outside inside{-exit, p, Vector3d::Zero()};
  inside.nearest[axis] = std::copysign(half[axis], p[axis]);
  inside.normal[axis] = std::copysign(1.0, p[axis]);
  return inside;
}

Outside PointToCylinder(double radius, double half, const Vector3d& p) {
  const double across = std::hypot(p.x(), p.y());
  const Vector3d radial =
      across > 0.0 ? Vector3d(p.x() / across, p.y() / across, 0.0) : Vector3d(Vector3d::UnitX());
  const Vector3d axial(0.0, 0.0, std::copysign(1.0, p.z()));
  const double side = across - radius;
  const double cap = std::abs(p.z()) - half;
  if (side <= 0.0 && cap <= 0.0) {
    if (side > cap) return {side, p - side * radial, radial};
    return {cap, p - cap * axial, axial};
  }
  const Vector3d gap = std::max(side, 0.0) * radial + std::max(cap, 0.0) * axial;
  const double z = std::clamp(p.z(), -half, half);
  const Vector3d nearest = std::min(across, radius) * radial + z * Vector3d::UnitZ();
  return {gap.stableNorm(), nearest, gap.stableNormalized()};
}

// Two segments c + s d, |s| <= half.
struct Segment {
  Vector3d centre, direction;
  double half;

  Vector3d At(double s) const { return centre + s * direction; }
  double Nearest(const Vector3d& p) const {
    return std::clamp(direction.dot(p - centre), -half, half);
  }
};

struct Parameters {
  double a, b;
};

Parameters ClosestParameters(const Segment& a, const Segment& b) {
  const Vector3d offset = b.centre - a.centre;
  const double along = a.direction.dot(b.direction);
  const double sine2 = a.direction.cross(b.direction).squaredNorm();
  if (sine2 < 1e-20) {  // parallel: the middle of what they have in common, if anything
    const double mid = a.direction.dot(offset);
    const double low = std::max(-a.half, mid - b.half), high = std::min(a.half, mid + b.half);
    const double s = std::clamp(0.5 * (low + high), -a.half, a.half);
    return {s, b.Nearest(a.At(s))};
  }
  // Each candidate is a pair of points, hence an upper bound; the true pair is among them.
  std::array<Parameters, 5> candidates;
  const double s = (a.direction.dot(offset) - along * b.direction.dot(offset)) / sine2;
  candidates[0].a = std::clamp(s, -a.half, a.half);
  candidates[0].b = b.Nearest(a.At(candidates[0].a));
  candidates[1] = {-a.half, b.Nearest(a.At(-a.half))};
  candidates[2] = {a.half, b.Nearest(a.At(a.half))};
  candidates[3] = {a.Nearest(b.At(-b.half)), -b.half};
  candidates[4] = {a.Nearest(b.At(b.half)), b.half};
  return *std::min_element(
      candidates.begin(), candidates.end(), [&](const Parameters& u, const Parameters& v) {
        return (a.At(u.a) - b.At(u.b)).squaredNorm() < (a.At(v.a) - b.At(v.b)).squaredNorm();
      });
}

CoreDistance SegmentToSegment(const CorePair& pair) {
  const Segment a{Vector3d::Zero(), Vector3d::UnitZ(), pair.a.half().z()};
  const Segment b{pair.X_AB.translation(), pair.X_AB.linear().col(2), pair.b.half().z()};
  const Parameters at = ClosestParameters(a, b);
  CoreDistance result{.point_a = a.At(at.a), .point_b = b.At(at.b)};
  const Vector3d gap = result.point_a - result.point_b;
  result.distance = gap.norm();
  if (result.distance > kNoDirection * (a.half + b.half)) {
    result.normal = gap / result.distance;
    return result;
  }
  // The axes cross: the shortest way apart is across both.
  const Vector3d across = a.direction.cross(b.direction);
  result.normal = across.squaredNorm() > 1e-20 ? across.normalized() : a.direction.unitOrthogonal();
  const Vector3d side = gap.isZero(0.0) ? Vector3d(-b.centre) : gap;
  if (result.normal.dot(side) < 0.0) result.normal = -result.normal;
  return result;
}

Outside PointToCore(const Collider& a, const Vector3d& p) {
  switch (a.core()) {
    case Core::kPoint:
      return PointToPoint(p);
    case Core::kSegment:
      return PointToSegment(a.half().z(), p);
    case Core::kBox:
      return PointToBox(a.half(), p);
    default:
      return PointToCylinder(a.half().x(), a.half().z(), p);
  }
}

}  // namespace

std::optional<CoreDistance> ClosedForm(const CorePair& pair) {
  if (pair.b.core() == Core::kPoint && pair.a.core() != Core::kHull) {
    const Vector3d p = pair.X_AB.translation();
    const Outside found = PointToCore(pair.a, p);
    return CoreDistance{found.distance, found.nearest, p, -found.normal};
  }
  if (pair.a.core() == Core::kSegment && pair.b.core() == Core::kSegment) {
    return SegmentToSegment(pair);
  }
  return std::nullopt;
}

}  // namespace oca::models::internal
