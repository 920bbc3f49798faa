// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/turned_repulsive_law.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace oca::robot {
namespace {

// Share of `up` in the way around, for ways that lead straight at the obstacle.
constexpr double kUpShare = 0.05;
// Less than this is no direction.
constexpr double kNoDirection = 1e-9;

}  // namespace

double TurnedRepulsiveLaw::Angle(double distance) const {
  return turn * std::clamp(2.0 * distance / repulsion.range, 0.0, 1.0);
}

Eigen::Vector3d TurnedRepulsiveLaw::Force(double distance, const Eigen::Vector3d& normal,
                                          const Eigen::Vector3d& axis) const {
  const double phi = Angle(distance);
  return repulsion.Force(distance) * (std::cos(phi) * normal + std::sin(phi) * axis.cross(normal));
}

Eigen::Vector3d TurnedRepulsiveLaw::Slope(double distance, const Eigen::Vector3d& normal,
                                          const Eigen::Vector3d& axis) const {
  const Eigen::Vector3d& n = normal;
  const Eigen::Vector3d t = axis.cross(n);
  const double phi = Angle(distance);
  const bool turning = distance > 0.0 && phi < turn;
  const double dphi = turning ? 2.0 * turn / repulsion.range : 0.0;
  return repulsion.Slope(distance) * (std::cos(phi) * n + std::sin(phi) * t) -
         repulsion.Force(distance) * dphi * (std::cos(phi) * t - std::sin(phi) * n);
}

Eigen::Vector3d AxisAround(const Eigen::Vector3d& normal, const Eigen::Vector3d& way,
                           const Eigen::Matrix3d& R) {
  const double length = way.norm();
  Eigen::Vector3d towards = kUpShare * R.col(2);
  if (length > kNoDirection) towards += way / length;
  Eigen::Vector3d axis = normal.cross(towards);
  if (axis.norm() < kNoDirection) axis = normal.cross(R.col(0));
  if (axis.norm() < kNoDirection) axis = normal.cross(R.col(1));
  return axis.normalized();
}

}  // namespace oca::robot
