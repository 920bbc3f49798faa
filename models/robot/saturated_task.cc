// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/saturated_task.h"

#include <algorithm>

namespace oca::robot {

JointVector SaturateInNullspace(const JointMatrix& M, const JointVector& b, const JointVector& wish,
                                const JointVector& lower, const JointVector& upper,
                                const Damping& damping) {
  constexpr double kTolerance = 1e-12;
  const Eigen::Index n = wish.size();
  JointVector base = wish;
  JointVector free = JointVector::Ones(n);
  JointVector u;
  for (Eigen::Index round = 0; round <= n; ++round) {
    const JointMatrix M_free = free.asDiagonal() * M * free.asDiagonal();
    const JointVector rest = b - M * base;
    u = base + SolveFiltered(M_free, free.cwiseProduct(rest), damping);
    Eigen::Index worst = -1;
    double most = kTolerance;
    for (Eigen::Index j = 0; j < n; ++j) {
      const double excess = std::max(u[j] - upper[j], lower[j] - u[j]);
      if (free[j] == 0.0 || excess <= most) continue;
      most = excess;
      worst = j;
    }
    if (worst < 0) break;
    base[worst] = std::clamp(u[worst], lower[worst], upper[worst]);
    free[worst] = 0.0;
  }
  return u.cwiseMax(lower).cwiseMin(upper);
}

}  // namespace oca::robot
