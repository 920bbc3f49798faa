// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/hull_support.h"

namespace oca::geometry::internal {

/// Farthest point of a convex core along `direction`, in a header because it is the innermost loop
/// of every search. Not for a half-space or a compound.
inline Eigen::Vector3d CoreSupport(const Collider& collider, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d& half = collider.half();
  const Eigen::Vector3d& d = direction;
  switch (collider.core()) {
    case Collider::Core::kPoint:
      return Eigen::Vector3d::Zero();
    case Collider::Core::kSegment:
      return {0.0, 0.0, std::copysign(half.z(), d.z())};
    case Collider::Core::kBox:
      return {std::copysign(half.x(), d.x()), std::copysign(half.y(), d.y()),
              std::copysign(half.z(), d.z())};
    case Collider::Core::kCylinder: {
      const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
      const double scale = across > 0.0 ? half.x() / across : 0.0;
      return {d.x() * scale, d.y() * scale, std::copysign(half.z(), d.z())};
    }
    case Collider::Core::kCone: {
      const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
      if (2.0 * half.z() * d.z() >= half.x() * across) return {0.0, 0.0, half.z()};
      const double scale = across > 0.0 ? half.x() / across : 0.0;
      return {d.x() * scale, d.y() * scale, -half.z()};
    }
    case Collider::Core::kEllipsoid: {
      const Eigen::Vector3d scaled = half.cwiseProduct(d);
      const double length = scaled.norm();
      if (!(length > 0.0)) return {half.x(), 0.0, 0.0};
      return half.cwiseProduct(scaled) / length;
    }
    default:
      return collider.hull()->vertices[FarthestVertex(*collider.hull(), d)];
  }
}

}  // namespace oca::geometry::internal
