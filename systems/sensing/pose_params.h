// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"

namespace oca::systems {

/// A pose as files give it; without rpy and quaternion it does not rotate.
struct PoseParams {
  Eigen::Vector3d xyz{Eigen::Vector3d::Zero()};
  std::optional<Eigen::Vector3d> rpy{};
  std::optional<Eigen::VectorXd> quaternion{};
  static void Describe(Fields<PoseParams>& fields);

  /// throws ConfigError naming `where` if it has both rotations, a quaternion that is not one, or
  /// a number that is not finite
  Eigen::Isometry3d Pose(const std::string& where) const;
};

/// The inverse, with a quaternion.
PoseParams PoseParamsOf(const Eigen::Isometry3d& X);

}  // namespace oca::systems
