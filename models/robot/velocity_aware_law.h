// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace oca::robot {

/// The force by which a potential pushes from what comes nearer, the more the faster. With x the
/// vector from the obstacle to the link along the unit normal n, p = |x| the distance and v the
/// velocity of the link's point relative to the obstacle's:
///
///     U = gain |v| (-c)^exponent s(p),   c = v . x / (|v| p),   if c < 0 and p < range
///     s = (1 - p / range)^2 / p,         F = -dU/dx at constant v
///
/// else 0. F has a part along the normal, which brakes, and one along the sideways part of v, which
/// leads around the obstacle. The factor (1 - p / range)^2 is not in the source: with it F fades to
/// 0 where the obstacle leaves the field. p is floored, so F is finite and its normal part outward
/// in contact. F is continuous in p, n and v.
///
/// source Park, Hoffmann, Pastor, Schaal, Humanoids 2008, eq. (14), (15); docs/theory.md
struct VelocityAwareLaw {
  double gain;      ///< N m s
  double exponent;  ///< at least 2
  double range;     ///< m
  double floor;     ///< m, 0 < floor < range

  /// N; `distance` m, v m/s
  Eigen::Vector3d Force(double distance, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& v) const;
  /// -dF / d(distance), N/m; of the floor below it, as the motion back out would meet it.
  Eigen::Vector3d Slope(double distance, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& v) const;
  /// -d(F . n) / d(v . n), N s/m, for the worst direction of v.
  double Damping(double distance) const;
};

}  // namespace oca::robot
