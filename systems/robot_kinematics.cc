// SPDX-License-Identifier: BSD-3-Clause
#include "systems/robot_kinematics.h"

#include "models/robot/kinematics.h"
#include "systems/model_links.h"

namespace oca::systems {

void RobotKinematics::Params::Describe(Fields<Params>& fields) {
  fields.Add("model", &Params::model, "", "name of the robot; may be left out if there is but one");
}

RobotKinematics::RobotKinematics(const Params& params, const ModelSet& models)
    : model_(MovableModel(models, params.model)),
      position(DeclareInput<Vector>("position", PositionSpec(*model_))),
      links(DeclareOutput<LinkPoses, &RobotKinematics::CalcLinks>("links", {}, position)) {}

void RobotKinematics::CalcLinks(VectorView q, LinkPoses& poses) const {
  if (poses.links.empty()) NameLinks(*model_, poses);
  models::ForwardKinematics(*model_, q, poses.poses);
}

}  // namespace oca::systems
