// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/trajectory.h"

#include <algorithm>
#include <cmath>

namespace oca::motion {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd OrZero(const std::optional<VectorXd>& values, Eigen::Index size) {
  return values ? *values : VectorXd::Zero(size);
}

/// k (k - 1) ... : the factor of s^(k - derivative) in the derivative of s^k.
double FallingFactorial(int k, int derivative) {
  double product = 1.0;
  for (int i = 0; i < derivative; ++i) product *= k - i;
  return product;
}

/// Velocities at the points, a column each, that make the acceleration continuous:
///
///     v_{i-1} / h_{i-1} + 2 (1 / h_{i-1} + 1 / h_i) v_i + v_{i+1} / h_i
///         = 3 (d_{i-1} / h_{i-1}^2 + d_i / h_i^2),   d_i = p_{i+1} - p_i
///
/// solved by elimination down and substitution up (the matrix is diagonally dominant).
MatrixXd SplineVelocities(const std::vector<KeyPoint>& points, Trajectory::Ends ends) {
  const auto last = static_cast<Eigen::Index>(points.size()) - 1;
  const Eigen::Index n = points.front().position.size();
  const auto h = [&](Eigen::Index i) { return points[i + 1].time - points[i].time; };
  const auto secant = [&](Eigen::Index i) -> VectorXd {
    return (points[i + 1].position - points[i].position) / h(i);
  };
  MatrixXd v(n, last + 1);
  VectorXd diagonal = VectorXd::Ones(last + 1);
  VectorXd above = VectorXd::Zero(last + 1);
  VectorXd below = VectorXd::Zero(last + 1);
  if (ends == Trajectory::Ends::kClamped) {
    v.col(0) = OrZero(points.front().velocity, n);
    v.col(last) = OrZero(points.back().velocity, n);
  } else {
    diagonal[0] = diagonal[last] = 2.0;
    above[0] = below[last] = 1.0;
    v.col(0) = 3.0 * secant(0);
    v.col(last) = 3.0 * secant(last - 1);
  }
  for (Eigen::Index i = 1; i < last; ++i) {
    below[i] = 1.0 / h(i - 1);
    above[i] = 1.0 / h(i);
    diagonal[i] = 2.0 * (below[i] + above[i]);
    v.col(i) = 3.0 * (secant(i - 1) * below[i] + secant(i) * above[i]);
  }
  for (Eigen::Index i = 1; i <= last; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    v.col(i) -= factor * v.col(i - 1);
  }
  v.col(last) /= diagonal[last];
  for (Eigen::Index i = last - 1; i >= 0; --i) {
    v.col(i) = (v.col(i) - above[i] * v.col(i + 1)) / diagonal[i];
  }
  return v;
}

}  // namespace

Trajectory::Trajectory(const std::vector<KeyPoint>& points)
    : first_(points.front().position), last_(points.back().position) {
  for (const KeyPoint& point : points) times_.push_back(point.time);
}

Trajectory Trajectory::Linear(const std::vector<KeyPoint>& points) {
  Trajectory trajectory(points);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    MatrixXd c(trajectory.size(), 2);
    c << points[i].position, points[i + 1].position - points[i].position;
    trajectory.segments_.push_back(std::move(c));
  }
  return trajectory;
}

Trajectory Trajectory::CubicHermite(const std::vector<KeyPoint>& points) {
  Trajectory trajectory(points);
  MatrixXd velocities(trajectory.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    velocities.col(i) = OrZero(points[i].velocity, trajectory.size());
  }
  trajectory.AddCubics(points, velocities);
  return trajectory;
}

Trajectory Trajectory::QuinticHermite(const std::vector<KeyPoint>& points) {
  Trajectory trajectory(points);
  const Eigen::Index n = trajectory.size();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double h = points[i + 1].time - points[i].time;
    const VectorXd d = points[i + 1].position - points[i].position;
    const VectorXd v0 = h * OrZero(points[i].velocity, n);
    const VectorXd v1 = h * OrZero(points[i + 1].velocity, n);
    const VectorXd a0 = h * h * OrZero(points[i].acceleration, n);
    const VectorXd a1 = h * h * OrZero(points[i + 1].acceleration, n);
    MatrixXd c(n, 6);
    c.col(0) = points[i].position;
    c.col(1) = v0;
    c.col(2) = a0 / 2.0;
    c.col(3) = 10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
    c.col(4) = -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
    c.col(5) = 6.0 * d - 3.0 * (v0 + v1) - 0.5 * (a0 - a1);
    trajectory.segments_.push_back(std::move(c));
  }
  return trajectory;
}

Trajectory Trajectory::CubicSpline(const std::vector<KeyPoint>& points, Ends ends) {
  Trajectory trajectory(points);
  if (points.size() > 1) trajectory.AddCubics(points, SplineVelocities(points, ends));
  return trajectory;
}

void Trajectory::AddCubics(const std::vector<KeyPoint>& points, const MatrixXd& velocities) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double h = points[i + 1].time - points[i].time;
    const VectorXd d = points[i + 1].position - points[i].position;
    const VectorXd v0 = h * velocities.col(i);
    const VectorXd v1 = h * velocities.col(i + 1);
    MatrixXd c(size(), 4);
    c << points[i].position, v0, 3.0 * d - 2.0 * v0 - v1, -2.0 * d + v0 + v1;
    segments_.push_back(std::move(c));
  }
}

void Trajectory::Evaluate(double time, int derivative, Eigen::Ref<VectorXd> out) const {
  const bool outside = time < times_.front() || time > times_.back() || segments_.empty();
  // The last position comes from the point, not from a sum that may round.
  if (outside || (derivative == 0 && time == times_.back())) {
    out.setZero();
    if (derivative == 0) out = time < times_.back() ? first_ : last_;
    return;
  }
  const auto later = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  const auto i = later - times_.begin() - 1;
  const double h = times_[i + 1] - times_[i];
  const double s = (time - times_[i]) / h;
  const MatrixXd& c = segments_[i];
  out.setZero();
  for (int k = static_cast<int>(c.cols()) - 1; k >= derivative; --k) {
    out = s * out + FallingFactorial(k, derivative) * c.col(k);
  }
  for (int i_derivative = 0; i_derivative < derivative; ++i_derivative) out /= h;
}

Eigen::VectorXd Trajectory::Evaluate(double time, int derivative) const {
  VectorXd out(size());
  Evaluate(time, derivative, out);
  return out;
}

}  // namespace oca::motion
