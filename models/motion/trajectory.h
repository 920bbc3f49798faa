// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "oca/models/motion/key_points.h"

namespace oca::motion {

/// A vector-valued piecewise polynomial through key points, with its derivatives.
///
/// On segment i, with h = t_{i+1} - t_i and s = (t - t_i) / h in [0, 1]:
///
///     position(t) = sum_k c_k s^k,   c_k a column of n numbers
///
/// Before the first point it holds the first position, after the last one the last, with zero
/// derivatives. At a point between two segments the derivatives are those of the later segment,
/// at the first and the last point those of the segment there is.
///
/// source De Boor, A Practical Guide to Splines, chapter IV; Biagiotti and Melchiorri, Trajectory
///        Planning for Automatic Machines and Robots, sections 2.1 and 4.4
class Trajectory {
 public:
  enum class Ends { kClamped, kNatural };

  // The points must be as CheckKeyPoints accepts them: at least one, times increasing.

  /// Straight lines; velocities and accelerations of the points are not used.
  static Trajectory Linear(const std::vector<KeyPoint>& points);
  /// Cubic Hermite: velocities of the points are met, absent ones are 0. C1.
  static Trajectory CubicHermite(const std::vector<KeyPoint>& points);
  /// Quintic Hermite: velocities and accelerations are met, absent ones are 0. C2.
  static Trajectory QuinticHermite(const std::vector<KeyPoint>& points);
  /// Cubic spline with continuous acceleration. Clamped: the velocities of the first and the last
  /// point are met, absent ones are 0. Natural: the acceleration is 0 at both ends.
  static Trajectory CubicSpline(const std::vector<KeyPoint>& points, Ends ends);

  Eigen::Index size() const { return last_.size(); }  ///< n
  const Eigen::VectorXd& goal() const { return last_; }
  const std::vector<double>& times() const { return times_; }  ///< s, of the key points
  /// The position (`derivative` 0), velocity (1), ... at `time` (s) into `out`, of length n.
  void Evaluate(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out) const;
  Eigen::VectorXd Evaluate(double time, int derivative) const;

 private:
  explicit Trajectory(const std::vector<KeyPoint>& points);
  /// Joins the points by cubics with these velocities, a column a point.
  void AddCubics(const std::vector<KeyPoint>& points, const Eigen::MatrixXd& velocities);

  std::vector<double> times_;              ///< s, of the points
  std::vector<Eigen::MatrixXd> segments_;  ///< n x (degree + 1): c_0, c_1, ...
  Eigen::VectorXd first_;
  Eigen::VectorXd last_;
};

}  // namespace oca::motion
