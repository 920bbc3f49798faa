// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/params.h"

namespace oca::systems {

/// A point that a trajectory passes at a given time.
struct KeyPoint {
  double time{0.0};                               ///< s
  Eigen::VectorXd position{};                     ///< n; u
  std::optional<Eigen::VectorXd> velocity{};      ///< n; u/s
  std::optional<Eigen::VectorXd> acceleration{};  ///< n; u/s^2
  static void Describe(Fields<KeyPoint>& fields);
};

/// Reads key points from a CSV file as CsvTable does: one a row, columns `time` (s), then the n
/// positions. A first row of names may say more: names that start with p, v and a are positions,
/// velocities and accelerations, n of each, in that order.
/// throws ConfigError `file:line: ...`.
std::vector<KeyPoint> ReadKeyPoints(const std::string& path);

/// The points given by the parameters `key_points` and `file`, of which one must be given.
/// throws ConfigError unless there is a point, all numbers are finite, times increase and all
/// points have the same number of joints.
std::vector<KeyPoint> KeyPointsFrom(const std::vector<KeyPoint>& key_points,
                                    const std::string& file);

}  // namespace oca::systems
