// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/velocity_methods.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {

int NumberOfLink(const robot::RobotModel& model, models::Name link) {
  for (int i = 0; i < model.num_links(); ++i) {
    if (model.links()[i].name == link) return i;
  }
  throw ConfigError(fmt::format("proximities: got one of '{}'; expected a link of '{}'",
                                link.text(), model.name().text()));
}

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

robot::JointVector RowOf(const robot::RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                         const Proximity& proximity) {
  const int link = NumberOfLink(model, proximity.link);
  const int other = proximity.own_link.empty() ? -1 : NumberOfLink(model, proximity.own_link);
  robot::JointVector row(model.num_positions());
  robot::DistanceRow(model, X_WL, link, proximity.point_on_link, other, proximity.point_on_obstacle,
                     proximity.normal, row);
  return row;
}

}  // namespace oca::systems
