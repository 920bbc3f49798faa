// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/name.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// How the force of a field on a link answers to the distance rho of one contact:
///
///     dF = -slope d(rho) - damping d(rho'),   rho' the rate of rho
///
/// All vectors have world axes.
struct ContactSlope {
  models::Name link;
  models::Name own_link;  ///< as in Proximity; two entries then tell of one distance
  Eigen::Vector3d point_on_link{Eigen::Vector3d::Zero()};
  Eigen::Vector3d point_on_obstacle{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitX()};  ///< from obstacle to link
  Eigen::Vector3d slope{Eigen::Vector3d::Zero()};    ///< N/m
  Eigen::Vector3d damping{Eigen::Vector3d::Zero()};  ///< N s/m
};
/// JSON: [{"link", "point_on_link", "point_on_obstacle", "normal", "slope", "damping"}]
struct ContactSlopes {
  std::vector<ContactSlope> slopes;
};

/// The geometry of `proximity` with the given slopes.
ContactSlope SlopeAt(const Proximity& proximity, const Eigen::Vector3d& slope,
                     const Eigen::Vector3d& damping = Eigen::Vector3d::Zero());

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::ContactSlopes> {
  static constexpr const char* kName = "ContactSlopes";
  static Fault Check(const systems::ContactSlopes& value, Look look);
  static void WriteJson(const systems::ContactSlopes& value, std::string& out);
  static systems::ContactSlopes ReadJson(std::string_view text);
};

}  // namespace oca
