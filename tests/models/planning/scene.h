// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/planning/clearance.h"
#include "models/robot/urdf.h"

namespace oca::models::test {

inline std::shared_ptr<const RobotModel> Arm(const std::string& name) {
  const std::string folder = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  LoadOptions options;
  options.srdf = folder + ".srdf";
  return std::make_shared<const RobotModel>(LoadUrdf(folder + ".urdf", options));
}

inline PlacedBody BoxAt(const Eigen::Vector3d& size, const Eigen::Vector3d& p_WO) {
  PlacedBody body{MakeCollider(Box{size}, "box")};
  body.X_WO.translation() = p_WO;
  return body;
}

/// The planar arm turns from stretched along x to stretched along y; a post stands on the diagonal,
/// within its reach, so that it has to fold to pass.
inline std::vector<PlacedBody> Post() { return {BoxAt({0.1, 0.1, 0.4}, {0.6, 0.6, 0.0})}; }

}  // namespace oca::models::test
