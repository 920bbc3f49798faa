// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/foxglove.h"
#include "oca/models/robot/robot_model.h"

namespace oca::record {

/// Adds what a link looks like to an entity in the link's frame: its visuals, meshes as binary STL;
/// its collision shapes if it has none. A mesh that cannot be read is left out.
void DrawLink(const robot::Link& link, SceneEntity& entity);

/// Its visuals alone; returns why meshes are left out, a line each.
std::vector<std::string> DrawVisuals(const robot::Link& link, SceneEntity& entity);
/// Its collision shapes alone, of a mesh the convex parts that it counts as.
void DrawCollisions(const robot::Link& link, const Colour& colour, SceneEntity& entity);

}  // namespace oca::record
