// SPDX-License-Identifier: BSD-3-Clause
// The damped Gauss-Newton steps of BandOptimizer.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "oca/models/planning/band_optimizer.h"

namespace oca::planning {
namespace {

constexpr double kLongestMove = 0.5;  // rad or m of a control point; distances bend
constexpr double kLeastGain = 2e-3;   // of the cost, in a step worth another one
constexpr double kMostDamping = 1e6;

}  // namespace

/// Solves (A + damping diag A) step = right by a Cholesky factor in blocks, L_ij for i - 3 <= j <=
/// i.
bool BandOptimizer::Step(const Normal& normal, double damping) {
  const Eigen::Index n = q_.size();
  factor_ = normal.blocks;
  for (int i = 0; i < num_variables_; ++i) {
    Eigen::MatrixXd& pivot = factor_[4 * i];
    pivot.diagonal() *= 1.0 + damping;
    for (int j = std::max(0, i - 3); j < i; ++j) {
      Eigen::MatrixXd& L_ij = factor_[4 * i + i - j];
      for (int k = std::max(0, i - 3); k < j; ++k) {
        L_ij.noalias() -= factor_[4 * i + i - k] * factor_[4 * j + j - k].transpose();
      }
      factor_[4 * j].triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(
          L_ij);
      pivot.noalias() -= L_ij * L_ij.transpose();
    }
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(pivot);
    if (llt.info() != Eigen::Success) return false;
  }
  step_ = normal.right;
  for (int i = 0; i < num_variables_; ++i) {
    auto y = step_.segment(i * n, n);
    for (int j = std::max(0, i - 3); j < i; ++j) {
      y.noalias() -= factor_[4 * i + i - j] * step_.segment(j * n, n);
    }
    factor_[4 * i].triangularView<Eigen::Lower>().solveInPlace(y);
  }
  for (int i = num_variables_ - 1; i >= 0; --i) {
    auto x = step_.segment(i * n, n);
    for (int j = i + 1; j <= std::min(num_variables_ - 1, i + 3); ++j) {
      x.noalias() -= factor_[4 * j + j - i].transpose() * step_.segment(j * n, n);
    }
    factor_[4 * i].triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  }
  return step_.allFinite();
}

double BandOptimizer::Relax(BandCurve& curve, int most) {
  const Eigen::Index n = q_.size();
  Normal now, next;
  Linearize(curve.controls(), true, now);
  Eigen::MatrixXd trial;
  double damping = 1e-3;
  for (int count = 0; count < most && damping < kMostDamping; ++count) {
    if (!Step(now, damping)) {
      damping *= 10.0;
      continue;
    }
    const double longest = step_.cwiseAbs().maxCoeff();
    if (longest > kLongestMove) step_ *= kLongestMove / longest;
    trial = curve.controls();
    for (int i = 3; i < num_controls_; ++i) {
      if (Variable(i) >= 0) trial.col(i) += step_.segment(Variable(i) * n, n);
    }
    Linearize(trial, true, next);
    if (!(next.cost < now.cost)) {
      damping = std::max(10.0 * damping, 1e-3);
      continue;
    }
    const bool done = now.cost - next.cost < kLeastGain * now.cost || longest < 1e-5;
    curve.controls() = trial;
    std::swap(now, next);
    damping = std::max(0.2 * damping, 1e-9);
    if (done) break;
  }
  return now.cost;
}

}  // namespace oca::planning
