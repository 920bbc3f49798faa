// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/models/motion/scripted_motion.h"

namespace oca::systems {

enum class MotionType {
  kStatic,
  kLinear,
  kTurning,
  kAccelerating,
  kSinusoidal,
  kCircular,
  kWaypoints,
  kCsv
};
inline constexpr std::array kMotionTypeNames{"static",     "linear",   "turning",   "accelerating",
                                             "sinusoidal", "circular", "waypoints", "csv"};
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
  std::optional<PerComponent> angular_velocity{};  // circular: a number; else a vector
  std::optional<Eigen::Vector3d> acceleration{};
  std::optional<double> start{};
  std::optional<double> stop{};
  std::optional<Eigen::Vector3d> amplitude{};
  std::optional<double> frequency{};
  std::optional<double> phase{};
  std::optional<Eigen::Vector3d> center{};
  std::optional<Eigen::Vector3d> axis{};
  std::optional<std::vector<WaypointParams>> waypoints{};
  std::optional<std::string> file{};
  std::optional<bool> smooth{};
  static void Describe(Fields<MotionParams>& fields);
};

/// The motion that starts from the pose X_0 in the frame: motion::StandingMotion, or that of
/// motion::LinearScript, TurningScript, AcceleratingScript, SinusoidalScript, CircularScript, or
/// along waypoints, which `csv` takes
/// from the columns time,x,y,z[,roll,pitch,yaw] of a file.
/// throws ConfigError naming `where` for keys that are missing or surplus, for what the motion
///        refuses, and a file that is no such table
motion::ScriptedMotion MakeMotion(const MotionParams& params, const Eigen::Isometry3d& X_0,
                                  const std::string& where);

}  // namespace oca::systems
