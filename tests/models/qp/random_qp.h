// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "oca/models/qp/projection_qp.h"

namespace oca::qp::test {

/// Problems as an avoidance loop meets them, and worse: `kind` 0 plain, 1 rows that repeat and
/// oppose each other, 2 rows nearly parallel, 3 integers, so that many are active at one point,
/// 4 rows that cannot be kept together, some of length 0, variables that cannot move, 5 rows of
/// lengths from 1 to 1e-18, 6 such rows that repeat, oppose or nearly equal each other.
class RandomQps {
 public:
  static constexpr int kKinds = 7;
  explicit RandomQps(unsigned seed) : random_(seed) {}

  ProjectionQp Make(int kind, int n, int m) {
    ProjectionQp qp(n, m);
    qp.num_rows = m;
    for (int j = 0; j < n; ++j) {
      qp.wish[j] = 2.0 * Number();
      qp.weights[j] = std::exp(Number());
      qp.lower[j] = -1.0 - Number();
      qp.upper[j] = 1.0 + Number();
      if (kind == 4 && Choose(4) == 0) qp.upper[j] = qp.lower[j];
    }
    for (int i = 0; i < m; ++i) MakeRow(kind, i, qp);
    return qp;
  }
  int Choose(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  double Number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

 private:
  void MakeRow(int kind, int i, ProjectionQp& qp) {
    auto row = qp.rows.row(i);
    for (int j = 0; j < row.size(); ++j) row[j] = kind == 3 ? Choose(3) - 1 : Number();
    qp.bounds[i] = kind == 3 ? Choose(3) - 1 : 0.5 * Number() - (kind == 4 ? 0.0 : 0.3);
    qp.penalties[i] = std::pow(10.0, 2.0 + 2.0 * Number());
    if (i > 0 && kind == 1) {
      row = (Choose(2) == 0 ? 1.0 : -1.0) * qp.rows.row(Choose(i));
      if (Choose(3) == 0) qp.bounds[i] = qp.bounds[i - 1];
    }
    if (i > 0 && kind == 2) {
      row = qp.rows.row(Choose(i)) + std::pow(10.0, -3.0 - 3.0 * (1.0 + Number())) * row;
    }
    if (kind == 4 && Choose(5) == 0) row.setZero();
    if (kind < 5) return;
    if (i > 0 && kind == 6) {
      const int other = Choose(i);
      row = qp.rows.row(other).normalized() * (Choose(2) == 0 ? 1.0 : -1.0) +
            (Choose(2) == 0 ? 0.0 : std::pow(10.0, -9.0 + 4.0 * Number())) * row;
    }
    // A bound may belong to the row or, as of one that is all rounding, be out of all reach.
    const double length = std::pow(10.0, -9.0 + 9.0 * Number());
    row *= length;
    if (Choose(2) == 0) qp.bounds[i] *= length;
  }

  std::mt19937 random_;
};

}  // namespace oca::qp::test
