// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>

namespace oca::models {

struct ConvexHull;  // models/geometry/convex_hull.h

/// Ball about the origin. `radius` m.
struct Sphere {
  double radius{0.0};
};

/// Cuboid about the origin. `size` full edge lengths along x, y, z, m.
struct Box {
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};
};

/// Right circular cylinder about the origin, axis z. `length` is the full height, m.
struct Cylinder {
  double radius{0.0};
  double length{0.0};
};

/// Cylinder with half-sphere ends about the origin, axis z. `length` of the straight part, m.
struct Capsule {
  double radius{0.0};
  double length{0.0};
};

/// Convex polyhedron; vertices in the shape's frame, m. Shared because copies are frequent.
struct ConvexMesh {
  std::shared_ptr<const ConvexHull> hull;
};

using Shape = std::variant<Sphere, Box, Cylinder, Capsule, ConvexMesh>;

}  // namespace oca::models
