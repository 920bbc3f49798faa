// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_curve.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>

namespace oca::planning {

BandCurve::BandCurve(Eigen::Index size, const std::vector<double>& times) {
  assert(times.size() >= 7);
  const double first = times[1] - times[0];
  const double last = times.back() - times[times.size() - 2];
  for (int i = 3; i > 0; --i) knots_.push_back(times.front() - i * first);
  knots_.insert(knots_.end(), times.begin(), times.end());
  for (int i = 1; i <= 3; ++i) knots_.push_back(times.back() + i * last);
  controls_.setZero(size, static_cast<Eigen::Index>(times.size()) + 2);
}

BandCurve::Basis BandCurve::BasisAt(double time) const {
  const auto above = std::upper_bound(knots_.begin() + 4, knots_.end() - 4, time);
  const auto k = static_cast<int>(above - knots_.begin()) - 1;
  const double* u = knots_.data();
  // low[d][i]: the basis functions of degree d that do not vanish here, number k - d + i.
  double low[4][4] = {{1.0}};
  for (int d = 1; d <= 3; ++d) {
    for (int i = 0; i <= d; ++i) {
      const int j = k - d + i;
      double sum = 0.0;
      if (i > 0) sum += (time - u[j]) / (u[j + d] - u[j]) * low[d - 1][i - 1];
      if (i < d) sum += (u[j + d + 1] - time) / (u[j + d + 1] - u[j + 1]) * low[d - 1][i];
      low[d][i] = sum;
    }
  }
  Basis basis{k - 3, {}};
  const auto derive = [&](const double* lower, int d, int i) {
    const int j = k - d + i;
    double sum = 0.0;
    if (i > 0) sum += lower[i - 1] / (u[j + d] - u[j]);
    if (i < d) sum -= lower[i] / (u[j + d + 1] - u[j + 1]);
    return d * sum;
  };
  double second[3];
  for (int i = 0; i < 3; ++i) second[i] = derive(low[1], 2, i);
  for (int i = 0; i < 4; ++i) {
    basis.weights[0][i] = low[3][i];
    basis.weights[1][i] = derive(low[2], 3, i);
    basis.weights[2][i] = derive(second, 3, i);
  }
  return basis;
}

void BandCurve::Evaluate(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out) const {
  out.setZero();
  Add(time, derivative, out);
}

void BandCurve::Add(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out) const {
  if (empty() || (derivative > 0 && (time < start() || time > end()))) return;
  const Basis basis = BasisAt(std::clamp(time, start(), end()));
  for (int i = 0; i < 4; ++i) {
    out += basis.weights[derivative][i] * controls_.col(basis.first + i);
  }
}

void BandCurve::StartWith(const Eigen::VectorXd& position, const Eigen::VectorXd& velocity,
                          const Eigen::VectorXd& acceleration) {
  const Basis basis = BasisAt(start());
  Eigen::Matrix3d weights;
  for (int d = 0; d < 3; ++d) {
    for (int i = 0; i < 3; ++i) weights(d, i) = basis.weights[d][i];
  }
  const Eigen::Matrix3d inverse = weights.inverse();
  for (int i = 0; i < 3; ++i) {
    controls_.col(i) =
        inverse(i, 0) * position + inverse(i, 1) * velocity + inverse(i, 2) * acceleration;
  }
}

void BandCurve::Follow(const std::function<Eigen::VectorXd(double time)>& shape) {
  const auto m = static_cast<int>(controls_.cols());
  for (int i = 3; i < m - 3; ++i) controls_.col(i) = shape(Centre(i));
  controls_.rightCols(3).colwise() = shape(end());
}

}  // namespace oca::planning
