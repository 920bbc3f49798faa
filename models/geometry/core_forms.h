// SPDX-License-Identifier: BSD-3-Clause
// All that depends on what a core is: whoever adds one adds it here, case by case.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/hull_support.h"

namespace oca::geometry::internal {

/// Farthest point of a convex core along `direction`; the innermost loop of every search. Not for a
/// half-space or a compound.
inline Eigen::Vector3d CoreSupport(const Collider& collider, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d& half = collider.half();
  const Eigen::Vector3d& d = direction;
  switch (collider.core()) {
    case Core::kPoint:
      return Eigen::Vector3d::Zero();
    case Core::kSegment:
      return {0.0, 0.0, std::copysign(half.z(), d.z())};
    case Core::kBox:
      return {std::copysign(half.x(), d.x()), std::copysign(half.y(), d.y()),
              std::copysign(half.z(), d.z())};
    case Core::kCylinder: {
      const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
      const double scale = across > 0.0 ? half.x() / across : 0.0;
      return {d.x() * scale, d.y() * scale, std::copysign(half.z(), d.z())};
    }
    case Core::kCone: {
      const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
      if (2.0 * half.z() * d.z() >= half.x() * across) return {0.0, 0.0, half.z()};
      const double scale = across > 0.0 ? half.x() / across : 0.0;
      return {d.x() * scale, d.y() * scale, -half.z()};
    }
    case Core::kEllipsoid: {
      const Eigen::Vector3d scaled = half.cwiseProduct(d);
      const double length = scaled.norm();
      if (!(length > 0.0)) return {half.x(), 0.0, 0.0};
      return half.cwiseProduct(scaled) / length;
    }
    default:
      return collider.hull()->vertices[FarthestVertex(*collider.hull(), d)];
  }
}

/// Whether a core has a round side: no search then ends in a finite number of steps.
inline bool IsRound(Core core) { return core >= Core::kCylinder && core <= Core::kEllipsoid; }

/// Whether a point of a core lies on the rim of a disc.
inline bool HasRim(const Collider& core, const Eigen::Vector3d& p) {
  return core.core() == Core::kCylinder || (core.core() == Core::kCone && p.z() < 0.0);
}

inline bool IsEllipsoid(const Collider& core) { return core.core() == Core::kEllipsoid; }

/// Whether two points of a core lie on the same branch.
inline bool SameBranch(const Collider& core, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  if (IsEllipsoid(core)) return true;
  if (HasRim(core, p) && HasRim(core, q)) return p.z() * q.z() > 0.0;
  return p == q;
}

/// Moves a point of a branch to where the branch is extreme along `d`, and gives the derivative of
/// that place by the direction.
inline void Follow(const Collider& core, const Eigen::Vector3d& d, Eigen::Vector3d* p,
                   Eigen::Matrix3d* curvature) {
  curvature->setZero();
  if (IsEllipsoid(core)) {
    const Eigen::Vector3d scaled = core.half().cwiseProduct(d);
    const double length = scaled.norm();
    *p = core.half().cwiseProduct(scaled) / length;
    *curvature = core.half().cwiseAbs2().asDiagonal();
    *curvature = (*curvature - *p * p->transpose()) / length;
  } else if (HasRim(core, *p)) {
    const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
    const Eigen::Vector3d along(-d.y() / across, d.x() / across, 0.0);
    const double radius = core.half().x();
    *p = {radius * along.y(), -radius * along.x(), p->z()};
    *curvature = radius / across * along * along.transpose();
  }
}

/// Where a point lies as seen from a core: signed distance (m, negative inside), the nearest point
/// of the surface, and the outward unit normal there. Frame of the core.
/// `point - nearest = distance * normal`.
struct Outside {
  double distance;
  Eigen::Vector3d nearest;
  Eigen::Vector3d normal;
};

inline Outside OutsidePoint(const Eigen::Vector3d& p) {
  const double distance = p.norm();
  if (!(distance > 0.0)) return {0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  return {distance, Eigen::Vector3d::Zero(), p / distance};
}

inline Outside OutsideSegment(double half, const Eigen::Vector3d& p) {
  const Eigen::Vector3d nearest(0.0, 0.0, std::clamp(p.z(), -half, half));
  const Eigen::Vector3d gap = p - nearest;
  const double distance = gap.norm();
  if (!(distance > 0.0)) return {0.0, nearest, Eigen::Vector3d::UnitX()};
  return {distance, nearest, gap / distance};
}

inline Outside OutsideBox(const Eigen::Vector3d& half, const Eigen::Vector3d& p) {
  const Eigen::Vector3d nearest = p.cwiseMax(-half).cwiseMin(half);
  const Eigen::Vector3d gap = p - nearest;
  const double distance = gap.norm();
  if (distance > 0.0) return {distance, nearest, gap / distance};
  int axis = 0;
  const double exit = (half - p.cwiseAbs()).minCoeff(&axis);
  Outside inside{-exit, p, Eigen::Vector3d::Zero()};
  inside.nearest[axis] = std::copysign(half[axis], p[axis]);
  inside.normal[axis] = std::copysign(1.0, p[axis]);
  return inside;
}

/// A body of revolution, seen in the half-plane (distance from the axis, z).
struct RadialOutside {
  double distance;
  Eigen::Vector2d nearest;
  Eigen::Vector2d normal;
};

inline RadialOutside OutsideRectangle(const Eigen::Vector2d& half, const Eigen::Vector2d& p) {
  const double side = p.x() - half.x();
  const double cap = std::abs(p.y()) - half.y();
  const double up = std::copysign(1.0, p.y());
  if (side <= 0.0 && cap <= 0.0) {
    if (side > cap) return {side, {half.x(), p.y()}, Eigen::Vector2d::UnitX()};
    return {cap, {p.x(), up * half.y()}, {0.0, up}};
  }
  const Eigen::Vector2d gap(std::max(side, 0.0), up * std::max(cap, 0.0));
  const double distance = gap.norm();
  return {distance, p - gap, gap / distance};
}

/// Triangle from the rim (radius, -half) to the apex (0, half).
inline RadialOutside OutsideTriangle(double radius, double half, const Eigen::Vector2d& p) {
  const double slant = std::hypot(radius, 2.0 * half);
  const Eigen::Vector2d up(-radius / slant, 2.0 * half / slant), out(up.y(), -up.x());
  const Eigen::Vector2d rim(radius, -half);
  const double side = out.dot(p - rim), base = -half - p.y();
  const double along = up.dot(p - rim);
  if (side <= 0.0 && base <= 0.0) {
    if (side > base) return {side, p - side * out, out};
    return {base, {p.x(), -half}, -Eigen::Vector2d::UnitY()};
  }
  if (base > 0.0 && p.x() <= radius) return {base, {p.x(), -half}, -Eigen::Vector2d::UnitY()};
  if (along > 0.0 && along < slant) return {side, p - side * out, out};
  const Eigen::Vector2d corner = along <= 0.0 ? rim : Eigen::Vector2d(0.0, half);
  const Eigen::Vector2d gap = p - corner;
  const double distance = gap.norm();
  if (!(distance > 0.0)) return {0.0, corner, out};
  return {distance, corner, gap / distance};
}

inline Outside Revolve(const RadialOutside& profile, const Eigen::Vector3d& p, double across) {
  const double x = across > 0.0 ? p.x() / across : 1.0, y = across > 0.0 ? p.y() / across : 0.0;
  const Eigen::Vector2d &q = profile.nearest, &n = profile.normal;
  return {profile.distance, {x * q.x(), y * q.x(), q.y()}, {x * n.x(), y * n.x(), n.y()}};
}

/// With the semi-axes e, e_min the least of them, and r_i = e_i^2 - e_min^2, the nearest point is
/// x_i = e_i^2 p_i / (t + r_i), t the largest root of sum (e_i p_i / (t + r_i))^2 = 1. The sum is
/// convex and falls in t, so Newton's method from below never overshoots.
inline Outside OutsideEllipsoid(const Eigen::Vector3d& e, const Eigen::Vector3d& p) {
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
  const Eigen::Vector3d normal = signs * gradient / length;
  return {(t - least * least) * length, signs * e.array().square() * gradient, normal};
}

/// The plane of a hull that a point is least below. Exact inside; outside a lower bound.
inline Outside OutsideOfHull(const ConvexHull& hull, const Eigen::Vector3d& p) {
  double most = -std::numeric_limits<double>::infinity();
  const ConvexHull::Plane* nearest = hull.planes.data();
  for (const ConvexHull::Plane& plane : hull.planes) {
    const double above = plane.normal.dot(p) - plane.offset;
    if (above > most) most = above, nearest = &plane;
  }
  return {most, p - most * nearest->normal, nearest->normal};
}

/// By algebra, for every core but kCompound; of a hull only from inside, see OutsideOfHull.
///
/// Where the direction is not unique (the middle of a box, a point on an axis) one of the shortest
/// is taken, always the same one.
/// source Ericson 2005, chapter 5; Eberly, Distance from a Point to an Ellipsoid, 2013
inline Outside OutsideOf(const Collider& core, const Eigen::Vector3d& p) {
  const Eigen::Vector3d& half = core.half();
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
      return {p.z(), {p.x(), p.y(), 0.0}, Eigen::Vector3d::UnitZ()};
    default:
      return OutsideOfHull(*core.hull(), p);
  }
}

/// Corners whose hull contains a core that is neither round all over nor endless; of a hull its
/// own.
inline std::vector<Eigen::Vector3d> CornersAround(const Collider& core) {
  std::vector<Eigen::Vector3d> corners;
  const Eigen::Vector3d& half = core.half();
  const auto add_polygon = [&](double z) {  // it contains a circle about the axis z
    constexpr int kCorners = 12;
    const double outer = half.x() / std::cos(std::numbers::pi / kCorners);
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kCorners;
      corners.emplace_back(outer * std::cos(angle), outer * std::sin(angle), z);
    }
  };
  switch (core.core()) {
    case Core::kCylinder:
      add_polygon(-half.z());
      add_polygon(half.z());
      return corners;
    case Core::kCone:
      add_polygon(-half.z());
      corners.emplace_back(0.0, 0.0, half.z());
      return corners;
    case Core::kHull:
      return core.hull()->vertices;
    default:
      for (int corner = 0; corner < 8; ++corner) {
        corners.emplace_back(corner & 1 ? half.x() : -half.x(), corner & 2 ? half.y() : -half.y(),
                             corner & 4 ? half.z() : -half.z());
      }
      return corners;
  }
}

}  // namespace oca::geometry::internal
