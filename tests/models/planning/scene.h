// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/models/robot/clearance.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning::test {

inline std::shared_ptr<const robot::RobotModel> Arm(const std::string& name) {
  const std::string folder = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  robot::LoadOptions options;
  options.srdf = folder + ".srdf";
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(folder + ".urdf", options));
}

inline robot::PlacedBody BoxAt(const Eigen::Vector3d& size, const Eigen::Vector3d& p_WO) {
  robot::PlacedBody body{geometry::MakeCollider(geometry::Box{size}, "box")};
  body.X_WO.translation() = p_WO;
  return body;
}

/// The planar arm turns from stretched along x to stretched along y; a post stands on the diagonal,
/// within its reach, so that it has to fold to pass.
inline std::vector<robot::PlacedBody> Post() { return {BoxAt({0.1, 0.1, 0.4}, {0.6, 0.6, 0.0})}; }

}  // namespace oca::planning::test
