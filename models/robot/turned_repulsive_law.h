// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "oca/models/robot/repulsive_law.h"

namespace oca::robot {

/// A repulsion that is turned about an axis a, towards the way around what is near:
///
///     F   = F_rep(rho) (cos(phi) n + sin(phi) a x n)
///     phi = turn clamp(2 rho / range, 0, 1)
///
/// with n the unit normal from the obstacle to the link. In contact phi is 0: F points straight
/// out, and F . n >= |F| cos(turn) everywhere.
///
/// source Singh, Stephanou, Wen, ICRA 1996 (circular fields); Haddadin et al., ICRA 2011;
///        docs/theory.md
struct TurnedRepulsiveLaw {
  RepulsiveLaw repulsion;
  double turn;  ///< rad, from 0 to less than pi / 2

  double Angle(double distance) const;
  /// N
  Eigen::Vector3d Force(double distance, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& axis) const;
  /// -dF / d(distance), N/m
  Eigen::Vector3d Slope(double distance, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& axis) const;
};

/// The unit axis that turns a normal towards a way that leads around:
///
///     a ~ n x (way / |way| + 0.05 up)
///
/// `up` is the z axis of R; it decides when the way leads straight at the obstacle, and if the
/// normal points up too, the x axis does.
Eigen::Vector3d AxisAround(const Eigen::Vector3d& normal, const Eigen::Vector3d& way,
                           const Eigen::Matrix3d& R);

}  // namespace oca::robot
