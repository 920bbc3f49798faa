// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string_view>
#include <vector>

#include "oca/models/geometry/convex_hull.h"
#include "oca/models/geometry/shape.h"

namespace oca::geometry {

class BallTree;

/// A shape prepared for distance queries: the set of all points within `radius` of a convex core.
///
/// Rounding costs nothing that way: the core distance less the two radii is exact, also in overlap.
/// Immutable; made by MakeCollider. Everything in the shape's frame, m.
class Collider {
 public:
  using Core = geometry::Core;
  struct Part {
    Eigen::Isometry3d X_SP;
    std::shared_ptr<const Collider> collider;
  };

  Collider(Shape shape, std::string_view where);

  const Shape& shape() const { return shape_; }
  Core core() const { return core_; }
  double radius() const { return radius_; }
  /// Half extents of the core's bounding box (of a segment (0, 0, half length); zero
  /// where Core says so).
  const Eigen::Vector3d& half() const { return half_; }
  /// Centre and radius of a sphere that contains the whole shape; infinite for a half-space, whose
  /// centre is the origin.
  const Eigen::Vector3d& centre() const { return centre_; }
  double bounding_radius() const { return bounding_radius_; }
  /// The same for the core alone.
  double core_bounding_radius() const { return bounding_radius_ - radius_; }
  /// Of a convex mesh, else null.
  const ConvexHull* hull() const { return hull_; }
  /// Of a compound, else none.
  const std::vector<Part>& parts() const { return parts_; }
  /// Balls around the parts, in the compound's frame, if there are many parts; else null.
  const BallTree* part_balls() const { return part_balls_.get(); }

  /// A point of the core that lies farthest along `direction` (of any length, zero included); of a
  /// compound the farthest of all parts. NaN for a half-space, which has none.
  Eigen::Vector3d Support(const Eigen::Vector3d& direction) const;

 private:
  void Prepare(const ConvexMesh& mesh, std::string_view where);
  void Prepare(const Compound& compound, std::string_view where);
  bool SameAsLast(const Shape& shape) const;

  Shape shape_;
  Core core_{Core::kPoint};
  double radius_{0.0};
  Eigen::Vector3d half_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d centre_{Eigen::Vector3d::Zero()};
  double bounding_radius_{0.0};
  const ConvexHull* hull_{nullptr};  // kept alive by shape_
  std::vector<Part> parts_;
  std::shared_ptr<const BallTree> part_balls_;
};

/// Prepares a shape. `where` names it in the error.
/// throws ModelError for a size that is not finite and positive; a shape
///        thinner than 1e-9 of its extent; a mesh without a hull; a compound without parts, with a
///        half-space or a compound among them, or with a pose that is not a finite rigid motion
std::shared_ptr<const Collider> MakeCollider(Shape shape, std::string_view where);

}  // namespace oca::geometry
