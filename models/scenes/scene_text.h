// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "oca/models/scenes/planning_scene.h"

namespace oca::scenes::internal {

/// Reads MoveIt's text format of what stands in a scene (.scene):
///
///     NAME
///     * ID
///     x y z              pose of the object; only in files of MoveIt 1.1 and later
///     qx qy qz qw
///     COUNT              of its shapes, then each of them
///     box                or sphere RADIUS, cylinder RADIUS LENGTH, cone RADIUS LENGTH,
///     1 1 1              plane A B C D, mesh VERTICES TRIANGLES and their numbers
///     x y z
///     qx qy qz qw
///     r g b a
///     COUNT              of its subframes, each NAME and a pose; where the object has a pose
///     .
///
/// Which of the two it is, the line behind the first ID says: a pose has blanks.
/// throws ModelError `file:line: what; got X; expected Y`
/// source MoveIt, planning_scene.cpp, loadGeometryFromStream; geometric_shapes,
///        shape_operations.cpp, constructShapeFromText
PlanningScene ReadSceneText(const std::filesystem::path& file);

}  // namespace oca::scenes::internal
