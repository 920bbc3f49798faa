// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace oca::geometry {

/// A convex polyhedron of nonzero volume; made by MakeConvexHull and immutable from then on.
/// All coordinates are in the frame of the points it was made from, m.
struct ConvexHull {
  std::string name;                           ///< source, for messages: a file or an element
  std::vector<Eigen::Vector3d> vertices;      ///< each is a corner of the hull, none is repeated
  std::vector<std::array<int, 3>> triangles;  ///< indices, counter-clockwise seen from outside
  /// The vertices once more as x x x ... y y y ... z z z ..., `column_size` each, a multiple of 8;
  /// the filling repeats the first vertex and so never wins a support search.
  std::vector<double> columns;
  int column_size{0};
  /// Outer planes of the triangles: no vertex has normal . vertex > offset. Unit normals, m. They
  /// touch the hull; of one with more than 4096 vertices they lie up to 3e-12 of its extent off.
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };
  std::vector<Plane> planes;
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};    ///< of the bounding sphere
  double radius{0.0};                                 ///< of the bounding sphere, m
  Eigen::Vector3d centroid{Eigen::Vector3d::Zero()};  ///< of the volume; always inside
  double volume{0.0};                                 ///< m^3
};

/// Smallest convex polyhedron that contains every one of `points` (repeated ones are welded).
///
/// Conservative: nothing is decimated; a point may stick out by 2e-12 of the extent (rounding).
/// throws ModelError naming `name`: fewer than 4 distinct points; NaN or infinite coordinates; all
///        points in one plane, or in a slab thinner than 1e-6 of the extent
/// source Barber, Dobkin, Huhdanpaa 1996 (quickhull)
std::shared_ptr<const ConvexHull> MakeConvexHull(std::span<const Eigen::Vector3d> points,
                                                 std::string_view name);

}  // namespace oca::geometry
