// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/point_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace oca::geometry::internal {
namespace {

using Core = Collider::Core;
using Eigen::Vector2d;
using Eigen::Vector3d;

Outside OutsidePoint(const Vector3d& p) {
  const double distance = p.norm();
  if (!(distance > 0.0)) return {0.0, Vector3d::Zero(), Vector3d::UnitZ()};
  return {distance, Vector3d::Zero(), p / distance};
}

Outside OutsideSegment(double half, const Vector3d& p) {
  const Vector3d nearest(0.0, 0.0, std::clamp(p.z(), -half, half));
  const Vector3d gap = p - nearest;
  const double distance = gap.norm();
  if (!(distance > 0.0)) return {0.0, nearest, Vector3d::UnitX()};
  return {distance, nearest, gap / distance};
}

Outside OutsideBox(const Vector3d& half, const Vector3d& p) {
  const Vector3d nearest = p.cwiseMax(-half).cwiseMin(half);
  const Vector3d gap = p - nearest;
  const double distance = gap.norm();
  if (distance > 0.0) return {distance, nearest, gap / distance};
  int axis = 0;
  const double exit = (half - p.cwiseAbs()).minCoeff(&axis);
  Outside inside{-exit, p, Vector3d::Zero()};
  inside.nearest[axis] = std::copysign(half[axis], p[axis]);
  inside.normal[axis] = std::copysign(1.0, p[axis]);
  return inside;
}

// A body of revolution, seen in the half-plane (distance from the axis, z).
struct Profile {
  double distance;
  Vector2d nearest;
  Vector2d normal;
};

Profile OutsideRectangle(const Vector2d& half, const Vector2d& p) {
  const double side = p.x() - half.x();
  const double cap = std::abs(p.y()) - half.y();
  const double up = std::copysign(1.0, p.y());
  if (side <= 0.0 && cap <= 0.0) {
    if (side > cap) return {side, {half.x(), p.y()}, Vector2d::UnitX()};
    return {cap, {p.x(), up * half.y()}, {0.0, up}};
  }
  const Vector2d gap(std::max(side, 0.0), up * std::max(cap, 0.0));
  const double distance = gap.norm();
  return {distance, p - gap, gap / distance};
}

// Triangle from the rim (radius, -half) to the apex (0, half).
Profile OutsideTriangle(double radius, double half, const Vector2d& p) {
  const double slant = std::hypot(radius, 2.0 * half);
  const Vector2d up(-radius / slant, 2.0 * half / slant), out(up.y(), -up.x());
  const Vector2d rim(radius, -half);
  const double side = out.dot(p - rim), base = -half - p.y();
  const double along = up.dot(p - rim);
  if (side <= 0.0 && base <= 0.0) {
    if (side > base) return {side, p - side * out, out};
    return {base, {p.x(), -half}, -Vector2d::UnitY()};
  }
  if (base > 0.0 && p.x() <= radius) return {base, {p.x(), -half}, -Vector2d::UnitY()};
  if (along > 0.0 && along < slant) return {side, p - side * out, out};
  const Vector2d corner = along <= 0.0 ? rim : Vector2d(0.0, half);
  const Vector2d gap = p - corner;
  const double distance = gap.norm();
  if (!(distance > 0.0)) return {0.0, corner, out};
  return {distance, corner, gap / distance};
}

Outside Revolve(const Profile& profile, const Vector3d& p, double across) {
  const double x = across > 0.0 ? p.x() / across : 1.0, y = across > 0.0 ? p.y() / across : 0.0;
  const Vector2d &q = profile.nearest, &n = profile.normal;
  return {profile.distance, {x * q.x(), y * q.x(), q.y()}, {x * n.x(), y * n.x(), n.y()}};
}

// With the semi-axes e, e_min the least of them, and r_i = e_i^2 - e_min^2, the nearest point is
// x_i = e_i^2 p_i / (t + r_i), t the largest root of sum (e_i p_i / (t + r_i))^2 = 1. The sum is
// convex and falls in t, so Newton's method from below never overshoots.
Outside OutsideEllipsoid(const Vector3d& e, const Vector3d& p) {
  constexpr double kNothing = 1e-150;  // stands for 0, where the root would coincide with a pole
  const double least = e.minCoeff();
  const Eigen::Array3d r = (e.array() - least) * (e.array() + least);
  const Eigen::Array3d y = p.cwiseAbs().cwiseMax(kNothing * least).array();
  const Eigen::Array3d top = e.array() * y;
  double t = (top - r).maxCoeff();
  for (int i = 0; i < 200; ++i) {
    const Eigen::Array3d below = (t + r).inverse();
    const Eigen::Array3d square = (top * below).square();
    const double excess = square.sum() - 1.0;
    const double step = excess / (2.0 * (square * below).sum());
    if (!(step > 1e-16 * t)) break;
    t += step;
  }
  const Eigen::Array3d gradient = y / (t + r);
  const double length = gradient.matrix().norm();
  const auto sign = [&](int i) { return std::copysign(1.0, p[i]); };
  const Eigen::Array3d signs(sign(0), sign(1), sign(2));
  const Vector3d normal = signs * gradient / length;
  return {(t - least * least) * length, signs * e.array().square() * gradient, normal};
}

}  // namespace

Outside OutsideOfHull(const ConvexHull& hull, const Vector3d& p) {
  double most = -std::numeric_limits<double>::infinity();
  const ConvexHull::Plane* nearest = hull.planes.data();
  for (const ConvexHull::Plane& plane : hull.planes) {
    const double above = plane.normal.dot(p) - plane.offset;
    if (above > most) most = above, nearest = &plane;
  }
  return {most, p - most * nearest->normal, nearest->normal};
}

Outside OutsideOf(const Collider& core, const Vector3d& p) {
  const Vector3d& half = core.half();
  switch (core.core()) {
    case Core::kPoint:
      return OutsidePoint(p);
    case Core::kSegment:
      return OutsideSegment(half.z(), p);
    case Core::kBox:
      return OutsideBox(half, p);
    case Core::kCylinder: {
      const double across = std::hypot(p.x(), p.y());
      return Revolve(OutsideRectangle({half.x(), half.z()}, {across, p.z()}), p, across);
    }
    case Core::kCone: {
      const double across = std::hypot(p.x(), p.y());
      return Revolve(OutsideTriangle(half.x(), half.z(), {across, p.z()}), p, across);
    }
    case Core::kEllipsoid:
      return OutsideEllipsoid(half, p);
    case Core::kHalfSpace:
      return {p.z(), {p.x(), p.y(), 0.0}, Vector3d::UnitZ()};
    default:
      return OutsideOfHull(*core.hull(), p);
  }
}

}  // namespace oca::geometry::internal
