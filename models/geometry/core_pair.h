// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "oca/models/geometry/core_forms.h"

namespace oca::geometry::internal {

/// Two cores with everything in the frame of A; the set A - B of all differences of their points is
/// what every algorithm here works on. Core distance = distance of the origin to that set.
struct CorePair {
  const Collider& a;
  const Collider& b;
  Eigen::Isometry3d X_AB;

  /// A point of A - B, and the points of A and B it comes from. `b` is in B's frame.
  struct Difference {
    Eigen::Vector3d w, a, b;
  };

  Difference At(const Eigen::Vector3d& point_a, const Eigen::Vector3d& point_b) const {
    return {point_a - X_AB * point_b, point_a, point_b};
  }
  /// The farthest point of A - B along `direction` (frame of A).
  Difference Support(const Eigen::Vector3d& direction) const {
    return At(CoreSupport(a, direction), CoreSupport(b, -(X_AB.linear().transpose() * direction)));
  }
  /// Whether one of them has a round side.
  bool IsRound() const { return internal::IsRound(a.core()) || internal::IsRound(b.core()); }
  /// A point well inside A - B or near it.
  Eigen::Vector3d Centre() const { return a.centre() - X_AB * b.centre(); }
  /// A - B lies within this distance of Centre(), m.
  double Extent() const { return a.core_bounding_radius() + b.core_bounding_radius(); }
};

/// Signed distance of two cores; points and normal (from B to A) in the frame of A.
struct CoreDistance {
  double distance{0.0};
  Eigen::Vector3d point_a{Eigen::Vector3d::Zero()};
  Eigen::Vector3d point_b{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitX()};
  double gap{0.0};  ///< proved upper bound less proved lower bound of the distance, m
};

}  // namespace oca::geometry::internal
