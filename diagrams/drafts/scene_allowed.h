// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/diagrams/drafts/scene_draft_text.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::drafts::internal {

/// The bodies that objects became, by their ids.
using BodiesOfObjects = std::map<std::string, std::vector<std::string>>;

/// Adds what a scene allows to touch: pairs of a link that moves, or a held object, with anything
/// to `ignored`, of a link with a held object to what that touches. Left out is what no distance
/// looks at: links without solids, neighbours, pairs that the SRDF disables.
void AddAllowed(const scenes::PlanningScene& scene, const robot::RobotModel& model,
                const BodiesOfObjects& bodies, SceneText& text);

}  // namespace oca::drafts::internal
