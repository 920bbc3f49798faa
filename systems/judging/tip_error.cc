// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/judging/tip_error.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/pose_error.h"

namespace oca::systems {
namespace {

const std::string& Checked(const std::string& link) {
  if (link.empty()) throw ConfigError("link: got an empty text; expected a link's name");
  return link;
}

}  // namespace

void TipError::Params::Describe(Fields<Params>& fields) {
  fields.Add("link", &Params::link, "", "the link that is looked at").Required();
  fields.Add("pose", &Params::pose, "", "that it shall have, in the world").Required();
}

TipError::Params TipError::Example() {
  Params params;
  params.link = "planar2_tip";
  params.pose.xyz = {0.5, 0.0, 0.0};
  return params;
}

TipError::TipError(const Params& params)
    : link_(Checked(Validated(params).link)),
      X_WG_(params.pose.Pose("pose")),
      links(DeclareInput<LinkPoses>("links")),
      position(DeclareOutput<Vector, &TipError::CalcPosition>("position", {3, Unit("m")}, links)),
      position_error(DeclareOutput<Vector, &TipError::CalcPositionError>("position_error",
                                                                         {1, Unit("m")}, links)),
      rotation_error(DeclareOutput<Vector, &TipError::CalcRotationError>(
          "rotation_error", {1, Unit("rad")}, links)) {}

const Eigen::Isometry3d& TipError::PoseOf(const LinkPoses& poses) const {
  const int index = poses.Find(link_);
  if (index >= 0) return poses.poses[index];
  throw ConfigError(
      fmt::format("links: got no pose of '{}'; expected one, the parameter link", link_.text()));
}

void TipError::CalcPosition(const LinkPoses& poses, MutableVectorView out) const {
  out = PoseOf(poses).translation();
}

void TipError::CalcPositionError(const LinkPoses& poses, MutableVectorView out) const {
  out[0] = robot::PoseError(PoseOf(poses), X_WG_).head<3>().norm();
}

void TipError::CalcRotationError(const LinkPoses& poses, MutableVectorView out) const {
  out[0] = robot::PoseError(PoseOf(poses), X_WG_).tail<3>().norm();
}

}  // namespace oca::systems
