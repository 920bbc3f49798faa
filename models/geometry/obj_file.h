// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

/// The vertices of an OBJ file and its faces, polygons as AddPolygon cuts them. Points, lines, free
/// forms, normals, textures, materials and names are passed over, faces of fewer than 3 corners
/// too. A vertex may have a weight, by which it is divided, or a colour.
///
/// throws ModelError `file:line: ...`: no text, a vertex without 3 finite numbers, a corner of a
///        face that names no vertex, more triangles than kMostTriangles
/// source Wavefront 1995, Object files (.obj), appendix B1 of the Advanced Visualizer manual
TriangleMesh ReadObj(const std::filesystem::path& file, std::string_view text);

}  // namespace oca::geometry::internal
