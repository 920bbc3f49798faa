// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string_view>

#include "models/geometry/convex_hull.h"
#include "models/shape.h"

namespace oca::models {

/// A shape prepared for distance queries: the set of all points within `radius` of a convex core.
///
/// | shape    | core                  | radius |
/// |----------|-----------------------|--------|
/// | sphere   | point                 | its own|
/// | capsule  | segment along z       | its own|
/// | box, cylinder, convex mesh | itself | 0   |
///
/// Rounding costs nothing that way: the core distance less the two radii is exact, also in overlap.
/// Immutable; made by MakeCollider. Everything in the shape's frame, m.
class Collider {
 public:
  enum class Core { kPoint, kSegment, kBox, kCylinder, kHull };

  Collider(const Shape& shape, std::string_view where);

  const Shape& shape() const { return shape_; }
  Core core() const { return core_; }
  double radius() const { return radius_; }
  /// Half extents of the core's bounding box (segment: (0, 0, half length); point and hull: zero).
  const Eigen::Vector3d& half() const { return half_; }
  /// Centre and radius of a sphere that contains the whole shape.
  const Eigen::Vector3d& centre() const { return centre_; }
  double bounding_radius() const { return bounding_radius_; }
  /// The same for the core alone.
  double core_bounding_radius() const { return bounding_radius_ - radius_; }

  /// A point of the core that lies farthest along `direction` (of any length, zero included).
  Eigen::Vector3d Support(const Eigen::Vector3d& direction) const;

 private:
  Shape shape_;
  Core core_{Core::kPoint};
  double radius_{0.0};
  Eigen::Vector3d half_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d centre_{Eigen::Vector3d::Zero()};
  double bounding_radius_{0.0};
  const ConvexHull* hull_{nullptr};  // kept alive by shape_
};

/// Prepares a shape. `where` names it in the error.
/// throws ModelError for a size that is not finite and positive, a box or cylinder thinner than
/// 1e-9
///        of its extent, or a mesh without a hull
std::shared_ptr<const Collider> MakeCollider(const Shape& shape, std::string_view where);

/// Radius of a sphere about the origin of the shape's frame that contains the shape, m.
double BoundingRadius(const Collider& collider);

}  // namespace oca::models
