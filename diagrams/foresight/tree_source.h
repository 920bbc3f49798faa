// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/diagrams/files/catalogue.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"
#include "oca/systems/signals/model_set.h"

namespace oca::foresight {

// What a file says before a diagram is made of it: from its tree, whose ${...} are worked out.

/// The map that the entry `name` of a section is; nullptr, with a problem, if there is none.
const Value* FindEntry(const Value& root, const char* section, const std::string& name,
                       Problems& problems);

/// The system `name` of section `systems` alone, as a root diagram of it, so that PositionsAheadOf
/// and ObstaclesAhead can be asked. It has no inputs, and is made without `period` and `frequency`:
/// what samples is then a function of time. Files are found as in the whole diagram. nullptr, with
/// problems, if there is no such system or it cannot be made alone.
std::unique_ptr<Diagram> MakeTreeSource(const Value& root, const std::string& name,
                                        const systems::ModelSet& models,
                                        const files::Catalogue& catalogue, Problems& problems);

/// Whether TellGoal has something to tell.
bool AsksForObstacles(const Value::Map& params);

/// Tells a goal with a clearance (systems::PoseGoalParams) in the parameters of a system what to
/// keep clear of: its `around` becomes the parameters of all in `systems`, a section of that name,
/// that say where obstacles are: whose parameters are what `around` lists. Parameters without one,
/// and a goal that names what is around it, stay as they are.
void TellGoal(const Value::Map& systems, const files::Catalogue& catalogue, Value::Map& params);

}  // namespace oca::foresight
