// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

enum class PlyPart { kVertices, kMesh };

/// The vertices of a PLY file (ascii, binary_little_endian or binary_big_endian), finite or not,
/// and of a mesh its faces: polygons as fans of triangles, those of fewer than 3 corners left out.
/// Other elements and properties are skipped, in whatever order they come. `text` is the file.
///
/// throws ModelError `file:line: ...`, of binary data `file: byte N: ...`: no PLY, a property of no
///        scalar type, no element `vertex` with x, y, z, of a mesh no element `face` with a list
///        vertex_indices or vertex_index, an index of no vertex, fewer elements than announced
/// source Turk 1994, The PLY polygon file format
TriangleMesh ReadPly(const std::filesystem::path& file, std::string_view text, PlyPart part);

}  // namespace oca::geometry::internal
