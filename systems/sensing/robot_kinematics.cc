// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/robot_kinematics.h"

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {

void RobotKinematics::Params::Describe(Fields<Params>& fields) { AddModel(fields); }

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
  const std::string wrong = robot::ImpossibleState(*model_, q);
  if (!wrong.empty()) throw ConfigError(wrong);
}

void RobotKinematics::CalcLinks(VectorView q, std::optional<VectorView> qdot,
                                LinkPoses& poses) const {
  if (poses.links.empty()) NameLinks(*model_, poses);
  robot::ForwardKinematics(*model_, q, poses.poses);
  if (!qdot) return;
  poses.velocities.resize(poses.poses.size());
  robot::LinkVelocities(*model_, poses.poses, *qdot, poses.velocities);
}

}  // namespace oca::systems
