// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For the source files that check signals; not installed.

#include <Eigen/Core>
#include <cmath>

namespace oca::systems {

/// What comes from outside is nearer and slower: from there on a double no longer tells 1e-10 m
/// apart; m, m/s, rad/s.
inline constexpr double kFarthest = 1e6;
/// Of the entries of R^T R from the identity's, of the length of a unit vector from 1.
inline constexpr double kRigid = 1e-9;

/// No entry is beyond kFarthest, or a NaN.
inline bool Near(const Eigen::Vector3d& vector) {
  return std::fabs(vector.x()) <= kFarthest && std::fabs(vector.y()) <= kFarthest &&
         std::fabs(vector.z()) <= kFarthest;
}

inline bool IsUnit(const Eigen::Vector3d& vector) {
  return std::fabs(vector.norm() - 1.0) <= kRigid;
}

}  // namespace oca::systems
