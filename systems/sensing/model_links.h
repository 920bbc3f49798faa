// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/port.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

// Between a robot model, which numbers its links, and LinkPoses, which names them.

/// throws ConfigError if there is no such model or nothing of it moves
std::shared_ptr<const robot::RobotModel> MovableModel(const ModelSet& models,
                                                      const std::string& name);

/// Length and unit of the joint positions, and where they can be: 2 pi rad or 10 m beyond the
/// limits, and never beyond 1e6 (a joint without limits that has turned 160,000 times, or a length
/// that doubles no longer tell to 1e-10). A reading out there is no posture of the robot. For
/// inputs: nothing looks at where states and outputs can be.
PortSpec PositionSpec(const robot::RobotModel& model);

/// The same of what can be anything: differences of positions, and requests, which may ask for what
/// the joints cannot do; and of states and outputs.
PortSpec DeltaSpec(const robot::RobotModel& model);

/// Length and unit of their rates.
PortSpec RateSpec(const robot::RobotModel& model);

/// Fills in names and bodies, and as many poses.
void NameLinks(const robot::RobotModel& model, LinkPoses& poses);

/// The number of a link. throws ConfigError naming `port` if the model has no such link
int LinkNumber(const robot::RobotModel& model, models::Name link, const char* port);

/// The poses in the order of the model. Those of `links` themselves if they are in this order,
/// else `reordered`, which is then filled: a link that `links` lacks stands where its fixed joint
/// puts it, or at the base if it is the root.
/// throws ConfigError if a movable link is missing or a name is not one of the model's links
std::span<const Eigen::Isometry3d> PosesInOrder(const robot::RobotModel& model,
                                                const LinkPoses& links,
                                                std::vector<Eigen::Isometry3d>& reordered);

}  // namespace oca::systems
