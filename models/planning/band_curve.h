// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

namespace oca::planning {

/// A vector-valued curve with continuous acceleration: a cubic B-spline
///
///     x(t) = sum_i N_i(t) c_i,   start() <= t <= end(),
///
/// of m control points over m - 3 intervals of any lengths. Three control points are the state at
/// the start, the last three are kept equal, so that the curve rests at its end and after it.
/// Before its start it is where it starts. Copies of the same size do not allocate.
/// source De Boor, A Practical Guide to Splines, chapter IX
class BandCurve {
 public:
  /// The four control points from `first` on that make the curve at a time, with their weights in
  /// the position, velocity and acceleration.
  struct Basis {
    int first;
    std::array<std::array<double, 4>, 3> weights;
  };

  BandCurve() = default;
  /// Zero. `times` are the ends of the intervals, ascending, at least seven of them.
  BandCurve(Eigen::Index size, const std::vector<double>& times);

  bool empty() const { return knots_.empty(); }
  double start() const { return knots_[3]; }
  double end() const { return knots_[knots_.size() - 4]; }
  Eigen::Index size() const { return controls_.rows(); }
  /// A column a control point.
  const Eigen::MatrixXd& controls() const { return controls_; }
  Eigen::MatrixXd& controls() { return controls_; }
  /// The times in question, one an interval and one more.
  std::vector<double> times() const { return {knots_.begin() + 3, knots_.end() - 3}; }
  /// The mean of the inner knots of control point i, the time at which it counts most.
  double Centre(int i) const { return (knots_[i + 1] + knots_[i + 2] + knots_[i + 3]) / 3.0; }

  Basis BasisAt(double time) const;
  void Evaluate(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Adds what Evaluate computes to `out`.
  void Add(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Chooses the first three control points.
  void StartWith(const Eigen::VectorXd& position, const Eigen::VectorXd& velocity,
                 const Eigen::VectorXd& acceleration);
  /// Chooses all others near `shape`, which should rest at the end.
  void Follow(const std::function<Eigen::VectorXd(double time)>& shape);

 private:
  std::vector<double> knots_;
  Eigen::MatrixXd controls_;
};

}  // namespace oca::planning
