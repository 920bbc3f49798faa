// SPDX-License-Identifier: BSD-3-Clause
#include "systems/robot_kinematics.h"

#include "framework/error.h"
#include "models/robot/joint_limits.h"
#include "models/robot/kinematics.h"
#include "systems/model_links.h"
#include "systems/roles.h"

namespace oca::systems {

void RobotKinematics::Params::Describe(Fields<Params>& fields) {
  fields.Add("model", &Params::model, "", "name of the robot; may be left out if there is but one");
}

RobotKinematics::RobotKinematics(const Params& params, const ModelSet& models)
    : model_(MovableModel(models, Validated(params).model)),
      position(DeclareInput<Vector>("position", PositionSpec(*model_))),
      velocity(DeclareOptionalInput<Vector>("velocity", RateSpec(*model_))),
      links(
          DeclareOutput<LinkPoses, &RobotKinematics::CalcLinks>("links", {}, position, velocity)) {
  DeclareInitialization<&RobotKinematics::CheckStart>(Writes<>(), position);
  DeclareRole(Kinematics{.position = position, .velocity = velocity, .links = links});
}

void RobotKinematics::CheckStart(VectorView q) const {
  const std::string wrong = models::ImpossibleState(*model_, q);
  if (!wrong.empty()) throw ConfigError(wrong);
}

void RobotKinematics::CalcLinks(VectorView q, std::optional<VectorView> qdot,
                                LinkPoses& poses) const {
  if (poses.links.empty()) NameLinks(*model_, poses);
  models::ForwardKinematics(*model_, q, poses.poses);
  if (!qdot) return;
  poses.velocities.resize(poses.poses.size());
  models::LinkVelocities(*model_, poses.poses, *qdot, poses.velocities);
}

}  // namespace oca::systems
