// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Limits of joints in a YAML file as MoveIt writes it, joint_limits.yaml:
///
///     joint_limits:
///       joint_1: {has_velocity_limits: true, max_velocity: 2.1,
///                 has_acceleration_limits: true, max_acceleration: 3.75}
///
/// They narrow those of the description, and never widen them: has_position_limits with
/// min_position and max_position or one of the two, has_velocity_limits, has_acceleration_limits,
/// has_deceleration_limits (as our limit is one for both, the lesser counts), has_jerk_limits,
/// has_effort_limits. A number counts if its has_... is not false. `joint_limits` may stand below
/// other keys; what else is there, as scaling factors of requests, is not read.
/// source MoveIt, joint_limits.yaml; ros2_control, joint_limits/joint_limits_rosparam.hpp
class JointLimitsFile {
 public:
  /// Narrows nothing.
  JointLimitsFile() = default;
  /// throws ModelError `file:line: ...` for what is no YAML or has no joint_limits, for numbers
  ///        that are missing, not finite or smaller than any limit (kLeastVelocity ...), and for
  ///        keys that look misspelt
  explicit JointLimitsFile(const std::filesystem::path& file);

  /// Narrows the ranges of joints.
  /// throws ModelError `file:line: ...` if there is no joint of a name, or no range is left
  void TightenRanges(std::vector<Joint>& joints) const;
  /// The same for all other limits.
  void TightenRates(std::vector<Joint>& joints) const;

 private:
  struct Entry {
    int line{0};
    std::optional<double> lower{}, upper{}, velocity{}, effort{}, acceleration{}, jerk{};
  };

  std::string where_;
  std::map<std::string, Entry> entries_;
};

}  // namespace oca::robot
