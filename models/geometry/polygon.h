// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

inline constexpr std::size_t kMostTriangles = 10'000'000;  ///< of a file

/// Appends the triangles of a polygon, a fan around a corner: its first one that bends inwards, the
/// first of one that has none. The fan covers the polygon and no more if at most one corner bends
/// inwards, and encloses the same volume however many do. Takes time in proportion to its corners,
/// of which fewer than 3 enclose nothing. `corners` are indices into the vertices.
void AddPolygon(const std::vector<int>& corners, TriangleMesh& mesh);

}  // namespace oca::geometry::internal
