// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace oca::motion {

/// Of a joint: above it, with limits or without, poses in double precision are no longer good to a
/// nanometre.
inline constexpr double kFarthestPosition = 1e6;  // rad, m

/// A point that a trajectory passes at a given time. The unit u is that of the joint, rad or m.
struct KeyPoint {
  double time{0.0};                               ///< s
  Eigen::VectorXd position{};                     ///< n; u
  std::optional<Eigen::VectorXd> velocity{};      ///< n; u/s
  std::optional<Eigen::VectorXd> acceleration{};  ///< n; u/s^2
};

/// Reads key points from a table as models::CsvTable does: one a row, the time (s), then the n
/// positions. If the columns have names their order is free: `time`; those that start with p, v and
/// a and end with a number from 0 or 1 on are positions, velocities and accelerations of that
/// joint; others are ignored. `joints`, if there are any, are the names of the n columns of
/// positions. throws ModelError `file:line: ...`.
std::vector<KeyPoint> ReadKeyPoints(const std::string& path,
                                    const std::vector<std::string>& joints = {});

/// throws ModelError, which begins with `where`, unless there is a point, all numbers are finite
///        and within kFarthestPosition, times increase and all points have as many joints
void CheckKeyPoints(const std::vector<KeyPoint>& points, const std::string& where);

}  // namespace oca::motion
