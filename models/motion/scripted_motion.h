// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "oca/models/motion/waypoints.h"

namespace oca::motion {

/// Where a body is in its frame F and how its origin moves there: m/s, rad/s, axes of the frame.
struct BodyState {
  Eigen::Isometry3d X_FO{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};
};

/// A motion of a body that is known for all times: the state at a time in s, of which the
/// velocities are the derivative of the pose, at corners the one to the right. Calls do not
/// allocate.
struct ScriptedMotion {
  std::function<BodyState(double time)> state;
  double fastest{0.0};  ///< |linear| is never larger, m/s
  double turning{0.0};  ///< |angular| is never larger, rad/s

  BodyState operator()(double time) const { return state(time); }
};

// Motions that start from the pose X_0 = (p_0, R_0) in the frame.

/// X_0, for ever.
ScriptedMotion StandingMotion(const Eigen::Isometry3d& X_0);

/// p_0 + velocity s, exp(angular_velocity s) R_0   with s = clamp(t, start, stop) - start
struct LinearScript {
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};          ///< m/s
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  ///< rad/s
  double start{0.0};                                          ///< s
  std::optional<double> stop{};                               ///< s; absent: never
};
/// velocity turned by angular_velocity s, and the body with it:
/// p_0 + integral_0^s exp(angular_velocity r) velocity dr, exp(angular_velocity s) R_0
/// with s = clamp(t, start, stop) - start
struct TurningScript {
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};          ///< m/s, at the start
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  ///< rad/s
  double start{0.0};                                          ///< s
  std::optional<double> stop{};                               ///< s; absent: never
};
/// p_0 + velocity s + acceleration s^2 / 2, R_0 with s = clamp(t, start, stop) - start, and from
/// `stop` on as fast as it is then; it rests before `start`. What is thrown, falls or brakes.
struct AcceleratingScript {
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};      ///< m/s, at the start
  Eigen::Vector3d acceleration{Eigen::Vector3d::Zero()};  ///< m/s^2
  double start{0.0};                                      ///< s
  double stop{0.0};                                       ///< s
};
/// p_0 + amplitude sin(2 pi frequency t + phase), R_0
struct SinusoidalScript {
  Eigen::Vector3d amplitude{Eigen::Vector3d::Zero()};  ///< m
  double frequency{0.0};                               ///< Hz
  double phase{0.0};                                   ///< rad
};
/// X_0 turned by angular_velocity t about the axis through center
struct CircularScript {
  Eigen::Vector3d center{Eigen::Vector3d::Zero()};  ///< m
  Eigen::Vector3d axis{Eigen::Vector3d::UnitZ()};   ///< of any length but 0
  double angular_velocity{0.0};                     ///< rad/s
};

// throw ModelError naming `where` and the member, for numbers that are not finite, a stop not after
// the start, a frequency that is not positive, an axis of length 0.
ScriptedMotion MakeMotion(const LinearScript& script, const Eigen::Isometry3d& X_0,
                          const std::string& where);
ScriptedMotion MakeMotion(const TurningScript& script, const Eigen::Isometry3d& X_0,
                          const std::string& where);
ScriptedMotion MakeMotion(const AcceleratingScript& script, const Eigen::Isometry3d& X_0,
                          const std::string& where);
ScriptedMotion MakeMotion(const SinusoidalScript& script, const Eigen::Isometry3d& X_0,
                          const std::string& where);
ScriptedMotion MakeMotion(const CircularScript& script, const Eigen::Isometry3d& X_0,
                          const std::string& where);

/// How a body goes from one waypoint to the next.
enum class Pace {
  kEven,   ///< with one velocity
  kSmooth  ///< from rest to rest with the least jerk, as a hand does: 10 x^3 - 15 x^4 + 6 x^5 of
           ///< the way at the share x of the time (Flash, Hogan, J. Neuroscience 5 (7), 1985)
};

/// Straight between waypoints, held before and after; rotations on the shortest arc; without rpy
/// R_0.
/// throws ModelError naming `where` for no waypoints, numbers that are not finite, times that do
///        not rise, and waypoints only some of which have rpy
ScriptedMotion MakeMotion(const std::vector<Waypoint>& waypoints, const Eigen::Isometry3d& X_0,
                          const std::string& where, Pace pace = Pace::kEven);

}  // namespace oca::motion
