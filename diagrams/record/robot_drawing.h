// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/diagrams/record/foxglove.h"
#include "oca/models/robot/robot_model.h"

namespace oca::record {

/// Adds what a link looks like to an entity in the link's frame: its visuals, meshes as binary STL;
/// its collision shapes if it has none. A mesh that cannot be read is left out.
void DrawLink(const robot::Link& link, SceneEntity& entity);

}  // namespace oca::record
