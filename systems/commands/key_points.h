// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"

namespace oca::systems {

/// A point that a trajectory passes at a given time.
struct KeyPoint {
  double time{0.0};                               ///< s
  Eigen::VectorXd position{};                     ///< n; u
  std::optional<Eigen::VectorXd> velocity{};      ///< n; u/s
  std::optional<Eigen::VectorXd> acceleration{};  ///< n; u/s^2
  static void Describe(Fields<KeyPoint>& fields);
};

/// Reads key points from a table as models::CsvTable does: one a row, the time (s), then the n
/// positions. If the columns have names their order is free: `time`; those that start with p, v and
/// a and end with a number from 0 or 1 on are positions, velocities and accelerations of that
/// joint; others are ignored. `joints`, if there are any, are the names of the n columns of
/// positions. throws ConfigError `file:line: ...`.
std::vector<KeyPoint> ReadKeyPoints(const std::string& path,
                                    const std::vector<std::string>& joints = {});

/// The points given by the parameters `key_points` and `file`, of which one must be given; `joints`
/// as ReadKeyPoints takes them.
/// throws ConfigError unless there is a point, all numbers are finite, times increase and all
/// points have the same number of joints.
std::vector<KeyPoint> KeyPointsFrom(const std::vector<KeyPoint>& key_points,
                                    const std::string& file,
                                    const std::vector<std::string>& joints = {});

}  // namespace oca::systems
