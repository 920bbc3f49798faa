// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace oca::motion {

/// Where a body is at a time, in its frame.
struct Waypoint {
  double time{0.0};                              ///< s
  Eigen::Vector3d xyz{Eigen::Vector3d::Zero()};  ///< m
  std::optional<Eigen::Vector3d> rpy{};          ///< rad; roll, pitch, yaw
};

/// The waypoints in a CSV file as CsvTable reads it. The first row names the columns, time,x,y,z or
/// time,x,y,z,roll,pitch,yaw; s, m and rad.
/// throws ModelError `file:line: ...`.
std::vector<Waypoint> ReadWaypoints(const std::string& file);

}  // namespace oca::motion
