// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/velocity_aware_law.h"

#include <algorithm>
#include <cmath>

namespace oca::robot {
namespace {

// With y = -c and u = -v . n: d(|v| y^b)/du = y^(b-1) (b - (b-1) y^2), largest at y^2 = b / (b+1).
double WorstRate(double b) {
  return std::pow(b / (b + 1.0), 0.5 * (b - 1.0)) * 2.0 * b / (b + 1.0);
}

}  // namespace

Eigen::Vector3d VelocityAwareLaw::Force(double distance, const Eigen::Vector3d& normal,
                                        const Eigen::Vector3d& v) const {
  const double speed = v.norm();
  const double approach = -v.dot(normal);
  if (distance >= range || approach <= 0.0) return Eigen::Vector3d::Zero();
  const double p = std::max(distance, floor);
  const double y = approach / speed;
  const double s = (1.0 - p / range) * (1.0 - p / range) / p;
  const double minus_ds = 1.0 / (p * p) - 1.0 / (range * range);
  const Eigen::Vector3d sideways = v + approach * normal;
  const double common = gain * std::pow(y, exponent - 1.0);
  return common * (exponent * s / p * sideways + approach * minus_ds * normal);
}

Eigen::Vector3d VelocityAwareLaw::Slope(double distance, const Eigen::Vector3d& normal,
                                        const Eigen::Vector3d& v) const {
  const double approach = -v.dot(normal);
  if (distance >= range || approach <= 0.0) return Eigen::Vector3d::Zero();
  const double p = std::max(distance, floor);
  const double s = (1.0 - p / range) * (1.0 - p / range) / p;
  const double minus_ds = 1.0 / (p * p) - 1.0 / (range * range);
  const Eigen::Vector3d sideways = v + approach * normal;
  const double common = gain * std::pow(approach / v.norm(), exponent - 1.0);
  return common * (exponent * (minus_ds / p + s / (p * p)) * sideways +
                   approach * 2.0 / (p * p * p) * normal);
}

double VelocityAwareLaw::Damping(double distance) const {
  if (distance >= range) return 0.0;
  const double p = std::max(distance, floor);
  return gain * WorstRate(exponent) * (1.0 / (p * p) - 1.0 / (range * range));
}

}  // namespace oca::robot
