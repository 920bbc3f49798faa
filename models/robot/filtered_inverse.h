// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace oca::robot {

// Inverses that stay small where a task loses rank, by the normal equations of any number of rows:
// M = sum J_i^T J_i, b = sum J_i^T xdot_i. Nothing here allocates.

constexpr int kMostFilteredJoints = 32;
using JointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostFilteredJoints,
                                  kMostFilteredJoints>;
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostFilteredJoints, 1>;

/// Numerical filtering: in a direction of singular value sigma the damping is
///
///     lambda^2 = most^2 (1 - (sigma / threshold)^2)   for sigma < threshold, else 0
///
/// so the inverse is exact where the task is well conditioned, and with most <= threshold no
/// direction gains more than 1 / most. Each direction has its own damping, so that rows may fade in
/// and out.
/// source Chiaverini 1997, eq. (13) and (17), there for the smallest singular value alone
struct Damping {
  double most{0.1};
  double threshold{0.1};
  double Squared(double sigma_squared) const {
    const double share = 1.0 - sigma_squared / (threshold * threshold);
    return share > 0.0 ? most * most * share : 0.0;
  }
};

/// x = sum_k v_k (v_k^T b) / (sigma_k^2 + lambda_k^2) for M = sum_k v_k sigma_k^2 v_k^T, symmetric
/// and positive semidefinite; 0 in directions where M and the damping are 0.
JointVector SolveFiltered(const JointMatrix& M, const JointVector& b, const Damping& damping);

/// N = I - sum_k v_k v_k^T sigma_k^2 / (sigma_k^2 + lambda_k^2): the motions that leave the task as
/// it is, and of nearly singular directions a part.
JointMatrix FilteredNullspace(const JointMatrix& M, const Damping& damping);

/// 1 where x is at or below `full`, 0 from `none` (above it) on; between them 3 s^2 - 2 s^3.
inline double Fade(double x, double full, double none) {
  if (x <= full) return 1.0;
  if (!(x < none)) return 0.0;
  const double s = (none - x) / (none - full);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace oca::robot
