// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/pseudo_inverse.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cassert>

namespace oca::robot {
namespace {

// sin^2 of the least angle between a row and the span of those before it.
constexpr double kLeastPivot = 1e-12;

// True if A = B B^T has a Cholesky factor that rounding did not make up.
bool Independent(const Eigen::MatrixXd& A, const Eigen::LLT<Eigen::MatrixXd>& factor) {
  if (factor.info() != Eigen::Success) return false;
  const Eigen::ArrayXd pivots = Eigen::MatrixXd(factor.matrixL()).diagonal().array().square();
  return (pivots >= kLeastPivot * A.diagonal().array()).all();
}

}  // namespace

Eigen::MatrixXd PseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& J) {
  if (J.size() == 0) return Eigen::MatrixXd::Zero(J.cols(), J.rows());
  const bool wide = J.rows() <= J.cols();
  const Eigen::MatrixXd A =
      wide ? Eigen::MatrixXd(J * J.transpose()) : Eigen::MatrixXd(J.transpose() * J);
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (!Independent(A, factor)) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(1e-9);
    return decomposition.compute(J).pseudoInverse();
  }
  if (wide) return factor.solve(J).transpose();
  return factor.solve(J.transpose());
}

Eigen::MatrixXd DampedPseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& J, double damping) {
  assert(damping > 0.0);
  const bool wide = J.rows() <= J.cols();
  Eigen::MatrixXd A =
      wide ? Eigen::MatrixXd(J * J.transpose()) : Eigen::MatrixXd(J.transpose() * J);
  A.diagonal().array() += damping * damping;
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (wide) return factor.solve(J).transpose();
  return factor.solve(J.transpose());
}

}  // namespace oca::robot
