// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/signal.h"

namespace oca::systems {

/// The joint velocity that a method of avoidance chose, and how much say avoidance had.
/// JSON: {"velocity": [n], "share", "rows"}
struct AvoidanceVelocity {
  Eigen::VectorXd velocity{};
  double share{0.0};                           ///< 0: the request's alone, 1: avoidance goes first
  int rows{0};                                 ///< proximities that took part
  std::vector<Eigen::Isometry3d> reordered{};  ///< memory, not part of the value
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::AvoidanceVelocity> {
  static constexpr const char* kName = "AvoidanceVelocity";
  static Fault Check(const systems::AvoidanceVelocity& value, Look look);
  static void WriteJson(const systems::AvoidanceVelocity& value, std::string& out);
  static systems::AvoidanceVelocity ReadJson(std::string_view text);
};

}  // namespace oca
