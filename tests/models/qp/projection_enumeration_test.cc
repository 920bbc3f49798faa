// SPDX-License-Identifier: BSD-3-Clause
// Small problems against all that an optimum can be.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <vector>

#include "oca/models/qp/projection_solver.h"
#include "tests/models/qp/random_qp.h"
#include "tests/sanitized.h"

namespace oca::qp::test {
namespace projection_enumeration_test {

using Real = long double;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// The best point of a ProjectionQp among all candidates. At the optimum each row is met, gives way
/// or does not matter, and each variable is at a side of its box or free. So each combination's
/// minimum, where it exists and lies in the box, is a feasible point, and one of them is the best.
class Enumeration {
 public:
  explicit Enumeration(const ProjectionQp& qp)
      : n_(qp.num_variables()),
        m_(qp.num_rows),
        wish_(qp.wish.cast<Real>()),
        weights_(qp.weights.cast<Real>()),
        lower_(qp.lower.cast<Real>()),
        upper_(qp.upper.cast<Real>()),
        rows_(qp.rows.topRows(m_).cast<Real>()),
        bounds_(qp.bounds.head(m_).cast<Real>()),
        penalties_(qp.penalties.head(m_).cast<Real>()) {
    Sides(0, {});
  }
  const RealVector& best() const { return best_; }

  Real Cost(const RealVector& u) const {
    Real cost = 0.5L * (weights_.array() * (u - wish_).array().square()).sum();
    for (int i = 0; i < m_; ++i) {
      cost += penalties_[i] * std::max(bounds_[i] - rows_.row(i).dot(u), 0.0L);
    }
    return cost;
  }

 private:
  struct Equality {
    RealVector normal;
    Real bound;
  };

  void Sides(int j, std::vector<Equality> met) {
    if (j == n_) {
      Rows(0, met, weights_.cwiseProduct(wish_));
      return;
    }
    Sides(j + 1, met);
    for (const Real side : {lower_[j], upper_[j]}) {
      met.push_back({RealVector::Unit(n_, j), side});
      Sides(j + 1, met);
      met.pop_back();
    }
  }

  void Rows(int i, std::vector<Equality>& met, const RealVector& pull) {
    if (i == m_) {
      Candidate(met, pull);
      return;
    }
    Rows(i + 1, met, pull);
    const Real length = rows_.row(i).norm();
    if (length == 0.0L) return;
    Rows(i + 1, met, pull + penalties_[i] * rows_.row(i).transpose());
    if (static_cast<int>(met.size()) == n_) return;
    met.push_back({rows_.row(i).transpose() / length, bounds_[i] / length});
    Rows(i + 1, met, pull);
    met.pop_back();
  }

  /// min 1/2 u^T W u - pull^T u on what is met.
  void Candidate(const std::vector<Equality>& met, const RealVector& pull) {
    RealVector u = pull.cwiseQuotient(weights_);
    const auto k = static_cast<Eigen::Index>(met.size());
    if (k > 0) {
      RealMatrix N(k, n_);
      RealVector b(k);
      for (Eigen::Index i = 0; i < k; ++i) {
        N.row(i) = met[static_cast<std::size_t>(i)].normal.transpose();
        b[i] = met[static_cast<std::size_t>(i)].bound;
      }
      const RealMatrix M = N * weights_.cwiseInverse().asDiagonal() * N.transpose();
      const Eigen::FullPivLU<RealMatrix> factors(M);
      if (!factors.isInvertible()) return;  // a subset of these rows leads to the same point
      const RealVector l = factors.solve(b - N * u);
      u += weights_.cwiseInverse().cwiseProduct(N.transpose() * l);
    }
    constexpr Real kRounding = 1e-13L;
    if (((lower_ - u).array() > kRounding).any() || ((u - upper_).array() > kRounding).any()) {
      return;
    }
    const Real cost = Cost(u);
    if (cost >= least_) return;
    least_ = cost;
    best_ = u;
  }

  int n_, m_;
  RealVector wish_, weights_, lower_, upper_;
  RealMatrix rows_;
  RealVector bounds_, penalties_, best_;
  Real least_{std::numeric_limits<Real>::infinity()};
};

TEST(ProjectionEnumerationTest, TheBestOfAllCandidatesIsTheAnswer) {
  RandomQps random(21);
  Real worst = 0.0L;
  for (int k = 0; k < Fewer(10000); ++k) {
    const int n = 1 + random.Choose(3);
    const int m = random.Choose(6);
    const ProjectionQp qp = random.Make(k % RandomQps::kKinds, n, m);
    QpSolution solution(qp);
    ProjectionSolver(n, m).Solve(qp, solution);
    const Enumeration all(qp);
    ASSERT_EQ(all.best().size(), n) << k;
    const Real off = (solution.u.cast<Real>() - all.best()).cwiseAbs().maxCoeff();
    // By the cost an optimum is known to the root of its rounding only.
    ASSERT_LT(off, 1e-7L) << k << ": " << solution.u.transpose();
    const Real rounding = 1e-14L * (1.0L + qp.penalties.sum());
    ASSERT_LT(all.Cost(solution.u.cast<Real>()) - all.Cost(all.best()), rounding) << k;
    worst = std::max(worst, off);
  }
  RecordProperty("worst", std::to_string(worst * 1e12L) + "e-12");
}

}  // namespace projection_enumeration_test
}  // namespace oca::qp::test
