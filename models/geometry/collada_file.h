// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

/// The triangles that the scene of a Collada file (1.4, 1.5) shows, m: geometries in their nodes,
/// those of instances too, skins at rest. Unit and transforms are applied, the up axis is not.
/// Materials, pictures, animations, cameras and lights are passed over.
///
/// throws ModelError `file:line: ...`: as ColladaTree and ColladaMeshes do, no scene, a reference
///        to another file or to nothing, a node that contains itself, more than 20,000 nodes or
///        ColladaMeshes::kMost triangles with what instances repeat, a transform of other numbers
/// source Khronos 2008, COLLADA - Digital asset schema release 1.4.1
TriangleMesh ReadCollada(const std::filesystem::path& file, std::string_view text);

}  // namespace oca::geometry::internal
