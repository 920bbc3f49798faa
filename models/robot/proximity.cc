// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/proximity.h"

#include <fmt/format.h>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {

int NumberOfLink(const RobotModel& model, models::Name link) {
  for (int i = 0; i < model.num_links(); ++i) {
    if (model.links()[i].name == link) return i;
  }
  throw models::ModelError(fmt::format("proximities: got one of '{}'; expected a link of '{}'",
                                       link.text(), model.name().text()));
}

void DistanceRow(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                 const Proximity& proximity, Eigen::Ref<Eigen::VectorXd> row) {
  const int link = NumberOfLink(model, proximity.link);
  const int other = proximity.own_link.empty() ? -1 : NumberOfLink(model, proximity.own_link);
  DistanceRow(model, X_WL, link, proximity.point_on_link, other, proximity.point_on_obstacle,
              proximity.normal, row);
}

}  // namespace oca::robot
