// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"

namespace oca::systems {

enum class MotionType { kStatic, kLinear, kSinusoidal, kCircular, kWaypoints, kCsv };
inline constexpr std::array kMotionTypeNames{"static",   "linear",    "sinusoidal",
                                             "circular", "waypoints", "csv"};
inline std::span<const char* const> EnumNames(MotionType) { return kMotionTypeNames; }

struct WaypointParams {
  double time{0.0};
  Eigen::Vector3d xyz{Eigen::Vector3d::Zero()};
  std::optional<Eigen::Vector3d> rpy{};
  static void Describe(Fields<WaypointParams>& fields);
};

/// How an obstacle moves; each type has its own keys (see MakeMotion) and refuses those of others.
struct MotionParams {
  MotionType type{MotionType::kStatic};
  std::optional<Eigen::Vector3d> velocity{};
  std::optional<PerComponent> angular_velocity{};  // linear: a vector; circular: a number
  std::optional<double> start{};
  std::optional<double> stop{};
  std::optional<Eigen::Vector3d> amplitude{};
  std::optional<double> frequency{};
  std::optional<double> phase{};
  std::optional<Eigen::Vector3d> center{};
  std::optional<Eigen::Vector3d> axis{};
  std::optional<std::vector<WaypointParams>> waypoints{};
  std::optional<std::string> file{};
  static void Describe(Fields<MotionParams>& fields);
};

/// Where a body is in its frame and how its origin moves there: m/s, rad/s, axes of the frame.
struct MotionState {
  Eigen::Isometry3d X_FO{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};
};

/// A scripted motion: the state at a time in s, of which the velocities are the derivative of the
/// pose, at corners the one to the right. Calls do not allocate.
struct Motion {
  std::function<MotionState(double time)> state;
  double fastest{0.0};  ///< |linear| is never larger, m/s
  double turning{0.0};  ///< |angular| is never larger, rad/s

  MotionState operator()(double time) const { return state(time); }
};

/// A motion that starts from the pose X_0 = (p_0, R_0) in the frame:
///
///     static      X_0
///     linear      p_0 + velocity s, exp(angular_velocity s) R_0
///                 with s = clamp(t, start, stop) - start
///     sinusoidal  p_0 + amplitude sin(2 pi frequency t + phase), R_0
///     circular    X_0 turned by angular_velocity t about the axis through center
///     waypoints   linear between waypoints {time, xyz, rpy}, held before and after; rotations on
///                 the shortest arc; without rpy R_0
///     csv         waypoints from the columns time,x,y,z[,roll,pitch,yaw] of a file
///
/// throws ConfigError naming `where` for keys that are missing, surplus or out of bounds, times
///        that do not rise, waypoints only some of which have rpy, and a file that is no such table
Motion MakeMotion(const MotionParams& params, const Eigen::Isometry3d& X_0,
                  const std::string& where);

/// The waypoints in a CSV file as CsvTable reads it. The first row names the columns, time,x,y,z or
/// time,x,y,z,roll,pitch,yaw; s, m and rad.
/// throws ConfigError `file:line: ...`.
std::vector<WaypointParams> ReadWaypoints(const std::string& file);

}  // namespace oca::systems
