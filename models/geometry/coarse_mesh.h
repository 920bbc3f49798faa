// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

/// A mesh of few triangles in the place of one of many, and whose they are.
struct CoarseMesh {
  TriangleMesh mesh;
  std::vector<int> nearest;  ///< for each triangle that there was, one of `mesh` at its place
};

/// At most `most` triangles: the mesh itself if it has no more, else with one vertex, their mean,
/// for all that lie in the same cell of a grid, as fine as `most` lets it be within a factor of
/// two. Takes n log n. Of a mesh that shrinks to points nothing is left, and `nearest` is all 0.
/// source Rossignac, Borrel 1993, Multi-resolution 3D approximations for rendering
CoarseMesh Coarsen(const TriangleMesh& mesh, std::size_t most);

}  // namespace oca::geometry::internal
