// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/velocity_methods.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {

std::shared_ptr<const robot::RobotModel> FilteredModel(const ModelSet& models,
                                                       const std::string& name) {
  auto model = MovableModel(models, name);
  if (model->num_positions() <= robot::kMostFilteredJoints) return model;
  throw ConfigError(fmt::format("model: got {} joints; expected at most {}", model->num_positions(),
                                robot::kMostFilteredJoints));
}

int TipNumber(const robot::RobotModel& model, const std::string& tip) {
  try {
    return tip.empty() ? robot::TipLink(model) : model.FindLink(tip);
  } catch (const models::ModelError& error) {
    throw ConfigError(std::string("tip: ") + error.what());
  }
}

}  // namespace oca::systems
