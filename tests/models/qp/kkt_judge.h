// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "oca/models/qp/projection_qp.h"

namespace oca::qp::test {

/// How far an answer is from optimal by the definition alone, in long double, with all multipliers
/// of the box made up: signs, stationarity, and each row, divided by its length, kept where it has
/// not given way and met where it pulls. A row of length 0 has nothing to say.
inline long double KktResidual(const ProjectionQp& qp, const QpSolution& solution) {
  using Real = long double;
  const auto n = static_cast<std::size_t>(qp.num_variables());
  std::vector<Real> multipliers(static_cast<std::size_t>(qp.num_rows), 0.0L);
  for (const QpActive& active : solution.active) {
    if (active.kind == QpActive::Kind::kRow) {
      multipliers[static_cast<std::size_t>(active.index)] = active.multiplier;
    }
  }
  std::vector<Real> gradient(n);
  for (std::size_t j = 0; j < n; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    gradient[j] = static_cast<Real>(qp.weights[column]) *
                  (static_cast<Real>(solution.u[column]) - qp.wish[column]);
  }
  Real worst = 0.0L;
  for (int i = 0; i < qp.num_rows; ++i) {
    const Real multiplier = multipliers[static_cast<std::size_t>(i)];
    Real excess = -static_cast<Real>(qp.bounds[i]);
    Real square = 0.0L;
    for (std::size_t j = 0; j < n; ++j) {
      const Real entry = qp.rows(i, static_cast<Eigen::Index>(j));
      gradient[j] -= multiplier * entry;
      excess += entry * solution.u[static_cast<Eigen::Index>(j)];
      square += entry * entry;
    }
    worst = std::max({worst, -multiplier, multiplier - qp.penalties[i]});
    if (square == 0.0L) continue;
    excess /= std::sqrt(square);
    if (multiplier > 0.0L) worst = std::max(worst, excess);
    if (multiplier < qp.penalties[i]) worst = std::max(worst, -excess);
  }
  for (std::size_t j = 0; j < n; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const Real u = solution.u[column];
    worst = std::max({worst, qp.lower[column] - u, u - qp.upper[column]});
    // A side of the box may hold back what leads out of it, and nothing else.
    const Real pull = gradient[j] / qp.weights[column];
    const Real room = pull > 0.0L ? u - qp.lower[column] : qp.upper[column] - u;
    worst = std::max(worst, std::min(std::fabs(pull), room));
  }
  return worst;
}

}  // namespace oca::qp::test
