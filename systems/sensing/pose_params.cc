// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/pose_params.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/models/geometry/rotation.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::systems {
namespace {

void CheckFinite(bool finite, const std::string& where) {
  if (!finite) throw ConfigError(where + ": got a NaN or an infinity; expected finite numbers");
}

}  // namespace

void PoseParams::Describe(Fields<PoseParams>& fields) {
  constexpr double kFarthestOrigin =
      1e6;                             // m; from there on a double no longer tells 1e-10 m apart
  constexpr double kMostTurned = 1e3;  // rad
  fields.Add("xyz", &PoseParams::xyz, "m", "position")
      .AtLeast(-kFarthestOrigin)
      .AtMost(kFarthestOrigin);
  fields.Add("rpy", &PoseParams::rpy, "rad", "roll, pitch, yaw about the fixed axes x, y, z")
      .AtLeast(-kMostTurned)
      .AtMost(kMostTurned);
  fields.Add("quaternion", &PoseParams::quaternion, "", "rotation [x, y, z, w], instead of rpy");
}

Eigen::Isometry3d PoseParams::Pose(const std::string& where) const {
  if (rpy && quaternion) {
    throw ConfigError(where + ": got rpy and quaternion; expected one of the two");
  }
  CheckFinite(xyz.allFinite() && (!rpy || rpy->allFinite()), where);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = xyz;
  if (rpy) pose.linear() = geometry::FromRollPitchYaw(*rpy).toRotationMatrix();
  if (quaternion) {
    if (quaternion->size() != 4) {
      throw ConfigError(fmt::format("{}.quaternion: got {} numbers; expected 4: [x, y, z, w]",
                                    where, quaternion->size()));
    }
    pose.linear() = WithConfigErrors([&] {
                      return geometry::FromQuaternion(*quaternion, where + ".quaternion");
                    }).toRotationMatrix();
  }
  return pose;
}

PoseParams PoseParamsOf(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond quaternion(X.linear());
  return {X.translation(), {}, Eigen::VectorXd(quaternion.coeffs())};
}

}  // namespace oca::systems
