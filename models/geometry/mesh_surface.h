// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "oca/models/geometry/convex_hull.h"
#include "oca/models/geometry/mesh.h"

namespace oca::geometry {

/// The mesh with one vertex for all that lie in the same cell of a grid of 1e-6 of its extent;
/// triangles that shrink to nothing are dropped.
TriangleMesh WeldVertices(const TriangleMesh& mesh);

/// Volume within a surface, m^3; none if the surface is open: an edge, after welding, that its
/// triangles do not pass as often in one direction as in the other. Bodies of one mesh that overlap
/// count twice where they do.
std::optional<double> EnclosedVolume(const TriangleMesh& mesh);

/// What a user should know of a mesh that counts as its hull: "counts as its convex hull, which
/// adds 0.0123 m^3 (35 %)"; empty if that is less than 1 %. The volume that an open surface would
/// have is not known, and the text says that.
std::string DescribeHullExcess(const TriangleMesh& mesh, const ConvexHull& hull);

/// A mesh file as its convex hull, which contains every vertex of the mesh.
struct MeshHull {
  std::shared_ptr<const ConvexHull> hull;
  std::string excess;  ///< as DescribeHullExcess says it
  /// Of a mesh in a plane or line: "is flat; counts as 5e-06 m thick"; else empty.
  std::string flatness;
};

/// Reads one, or finds it as it was read (models::FileCache). A flat one, such as a sticker, gets a
/// thickness of 1e-4 of its extent.
/// throws ModelError as LoadMesh and MakeConvexHull do
MeshHull LoadMeshHull(const std::filesystem::path& file,
                      const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

}  // namespace oca::geometry
