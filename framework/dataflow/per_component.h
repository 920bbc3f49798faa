// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace oca {

/// A number for every component, or a list with one number a component.
class PerComponent {
 public:
  PerComponent(double scalar = 0.0)  // NOLINT: a number is a parameter
      : values_(Eigen::VectorXd::Constant(1, scalar)), scalar_(true) {}
  /// A column, of fixed length or worked out: Eigen::Vector3d(1, 2, 3), Eigen::VectorXd::Zero(3).
  template <class Derived>
  PerComponent(const Eigen::MatrixBase<Derived>& values)  // NOLINT: a column is a parameter
      requires(Derived::ColsAtCompileTime == 1)
      : values_(values), scalar_(false) {}

  bool scalar() const { return scalar_; }
  const Eigen::VectorXd& values() const { return values_; }
  double operator[](Eigen::Index i) const { return values_[scalar_ ? 0 : i]; }
  double& operator[](Eigen::Index i) { return values_[scalar_ ? 0 : i]; }

 private:
  Eigen::VectorXd values_;
  bool scalar_;
};

}  // namespace oca
