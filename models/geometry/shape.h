// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <variant>
#include <vector>

namespace oca::geometry {

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
  std::shared_ptr<const ConvexHull> hull{};
};

/// Right circular cone, axis z: base at z = -length / 2, apex at z = +length / 2, m.
struct Cone {
  double radius{0.0};
  double length{0.0};
};

/// Ellipsoid about the origin. `radii` semi-axes along x, y, z, m.
struct Ellipsoid {
  Eigen::Vector3d radii{Eigen::Vector3d::Zero()};
};

/// All points with z <= 0: a floor whose surface is the xy plane of the frame.
struct HalfSpace {};

struct CompoundPart;

/// Union of convex parts under one pose. None of them is a half-space or a compound.
struct Compound {
  std::vector<CompoundPart> parts;
};

using Shape =
    std::variant<Sphere, Box, Cylinder, Capsule, ConvexMesh, Cone, Ellipsoid, HalfSpace, Compound>;

/// What is left of a shape without its round skin, from simple to intricate; algorithms put the
/// simpler one second.
enum class Core {
  kPoint,      ///< of a sphere; no extents
  kSegment,    ///< of a capsule, along z
  kBox,        ///< the box itself
  kCylinder,   ///< the cylinder itself
  kCone,       ///< the cone itself
  kEllipsoid,  ///< the ellipsoid itself; its extents are the semi-axes
  kHull,       ///< of a convex mesh; no extents
  kHalfSpace,  ///< it has no core that ends; no extents
  kCompound    ///< each part has one; no extents
};

/// `X_SP` pose of the part in the frame of the compound.
struct CompoundPart {
  Eigen::Isometry3d X_SP{Eigen::Isometry3d::Identity()};
  Shape shape{};
};

}  // namespace oca::geometry
