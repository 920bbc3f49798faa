// SPDX-License-Identifier: BSD-3-Clause
// The same problems for Ipopt, which knows nothing of active sets: an interior-point method in u
// and the slacks.
#include <gtest/gtest.h>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

#include "oca/models/qp/projection_solver.h"
#include "tests/models/qp/random_qp.h"

namespace oca::qp::test {
namespace ipopt_comparison_test {

using Ipopt::Index;
using Ipopt::Number;

/// Variables (u, s); row i is a_i^T u + s_i >= b_i.
class AsNlp final : public Ipopt::TNLP {
 public:
  AsNlp(const ProjectionQp& qp, Eigen::VectorXd& answer)
      : qp_(qp), n_(qp.num_variables()), m_(qp.num_rows), answer_(answer) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian,
                    IndexStyleEnum& style) override {
    n = n_ + m_;
    m = m_;
    jacobian = m_ * (n_ + 1);
    hessian = n_;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index, Number* lower, Number* upper, Index, Number* row_lower,
                       Number* row_upper) override {
    for (int j = 0; j < n_; ++j) {
      lower[j] = qp_.lower[j];
      upper[j] = qp_.upper[j];
    }
    for (int i = 0; i < m_; ++i) {
      lower[n_ + i] = 0.0;
      upper[n_ + i] = 1e20;
      row_lower[i] = qp_.bounds[i];
      row_upper[i] = 1e20;
    }
    return true;
  }
  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    std::fill_n(x, n_ + m_, 0.5);
    return true;
  }
  bool eval_f(Index, const Number* x, bool, Number& value) override {
    value = 0.0;
    for (int j = 0; j < n_; ++j) {
      value += 0.5 * qp_.weights[j] * (x[j] - qp_.wish[j]) * (x[j] - qp_.wish[j]);
    }
    for (int i = 0; i < m_; ++i) value += qp_.penalties[i] * x[n_ + i];
    return true;
  }
  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    for (int j = 0; j < n_; ++j) gradient[j] = qp_.weights[j] * (x[j] - qp_.wish[j]);
    for (int i = 0; i < m_; ++i) gradient[n_ + i] = qp_.penalties[i];
    return true;
  }
  bool eval_g(Index, const Number* x, bool, Index, Number* g) override {
    const Eigen::Map<const Eigen::VectorXd> u(x, n_);
    for (int i = 0; i < m_; ++i) g[i] = qp_.rows.row(i).dot(u) + x[n_ + i];
    return true;
  }
  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index* row, Index* column,
                  Number* values) override {
    int k = 0;
    for (int i = 0; i < m_; ++i) {
      for (int j = 0; j <= n_; ++j, ++k) {
        if (values != nullptr) {
          values[k] = j < n_ ? qp_.rows(i, j) : 1.0;
        } else {
          row[k] = i;
          column[k] = j < n_ ? j : n_ + i;
        }
      }
    }
    return true;
  }
  bool eval_h(Index, const Number*, bool, Number factor, Index, const Number*, bool, Index,
              Index* row, Index* column, Number* values) override {
    for (int j = 0; j < n_; ++j) {
      if (values != nullptr) {
        values[j] = factor * qp_.weights[j];
      } else {
        row[j] = column[j] = j;
      }
    }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*,
                         Index, const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    answer_ = Eigen::Map<const Eigen::VectorXd>(x, n_);
  }

 private:
  const ProjectionQp& qp_;
  const int n_, m_;
  Eigen::VectorXd& answer_;
};

double Objective(const ProjectionQp& qp, const Eigen::VectorXd& u) {
  double value = 0.5 * (u - qp.wish).cwiseAbs2().dot(qp.weights);
  for (int i = 0; i < qp.num_rows; ++i) {
    value += qp.penalties[i] * std::max(qp.bounds[i] - qp.rows.row(i).dot(u), 0.0);
  }
  return value;
}

TEST(IpoptComparisonTest, AgreesOnProblemsOfEveryKind) {
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = IpoptApplicationFactory();
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetStringValue("sb", "yes");
  application->Options()->SetNumericValue("tol", 1e-10);
  application->Options()->SetNumericValue("bound_relax_factor", 0.0);
  application->Options()->SetStringValue("hessian_constant", "yes");
  application->Options()->SetStringValue("jac_c_constant", "yes");
  application->Options()->SetStringValue("jac_d_constant", "yes");
  application->Options()->SetStringValue("fixed_variable_treatment", "make_parameter");
  ASSERT_EQ(application->Initialize(), Ipopt::Solve_Succeeded);
  RandomQps random(15);
  int compared = 0;
  constexpr int kProblems = 500;
  for (int k = 0; k < kProblems; ++k) {
    const int n = 2 + random.Choose(6);
    const int m = 1 + random.Choose(20);
    const ProjectionQp qp = random.Make(k % RandomQps::kKinds, n, m);
    QpSolution solution(qp);
    ProjectionSolver(n, m).Solve(qp, solution);
    Eigen::VectorXd other = solution.u;
    Ipopt::SmartPtr<Ipopt::TNLP> nlp = new AsNlp(qp, other);
    const auto status = application->OptimizeTNLP(nlp);
    const double ours = Objective(qp, solution.u);
    // Ours is never the worse one, whether Ipopt is content with its own answer or not.
    if (!((other - qp.upper).maxCoeff() > 0.0 || (qp.lower - other).maxCoeff() > 0.0)) {
      EXPECT_LE(ours, Objective(qp, other) + 1e-9 * (1.0 + std::fabs(ours))) << k;
    }
    if (status != Ipopt::Solve_Succeeded) continue;
    ++compared;
    EXPECT_NEAR((solution.u - other).norm(), 0.0, 2e-4) << k;
    EXPECT_NEAR(ours, Objective(qp, other), 1e-6 * (1.0 + std::fabs(ours))) << k;
  }
  EXPECT_GT(compared, kProblems * 9 / 10);
}

}  // namespace ipopt_comparison_test
}  // namespace oca::qp::test
