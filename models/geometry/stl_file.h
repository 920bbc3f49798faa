// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

/// The triangles of an STL file, each with vertices of its own. Normals are not read. Text may
/// begin with a byte order mark and blank lines, in small letters or capitals, with several solids;
/// a binary file may begin with `solid` and end with up to 49 bytes more than its triangles take.
///
/// throws ModelError `file:line: ...` of text, `file: ...` of a binary file: another word or number
///        than the format has there, a loop of more or fewer than 3 vertices, a text without its
///        endsolid, more or fewer bytes than the triangles take that are announced
/// source 3D Systems 1989, Stereolithography interface specification
TriangleMesh ReadStl(const std::filesystem::path& file, std::string_view bytes);

}  // namespace oca::geometry::internal
