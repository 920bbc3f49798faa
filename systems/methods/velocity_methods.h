// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>

#include "oca/models/robot/filtered_inverse.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

// What methods that choose joint velocities share.

/// throws ConfigError as MovableModel, and if it has more joints than models::JointVector holds
std::shared_ptr<const robot::RobotModel> FilteredModel(const ModelSet& models,
                                                       const std::string& name);

/// The link `tip`, or the last one if it is empty. throws ConfigError if there is no such link, or
/// several are last and none is named
int TipNumber(const robot::RobotModel& model, const std::string& tip);

/// The number of a link. throws ConfigError if the model has no such link
int NumberOfLink(const robot::RobotModel& model, models::Name link);

/// d(distance)/d(position) of every joint. throws ConfigError if it is of no link of the model
robot::JointVector RowOf(const robot::RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                         const Proximity& proximity);

}  // namespace oca::systems
