// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

namespace oca::geometry {

/// Triangles as a file gives them, in the frame of the file, m.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< indices into vertices
};

/// Reads all triangles of an STL (text or binary), OBJ, Collada or PLY file (ascii or binary).
///
/// Node transforms and the unit of a Collada file are applied; its up axis is not, because URDF
/// users draw in the frame of the link. `scale` multiplies x, y, z; a negative one mirrors and the
/// triangles keep their outer side.
/// throws ModelError naming the file: missing, empty or above 100 MB; unknown extension; content
///        that is no such mesh, with its line; no triangle; a vertex or the scale not finite; zero
///        scale
TriangleMesh LoadMesh(const std::filesystem::path& file,
                      const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

}  // namespace oca::geometry
