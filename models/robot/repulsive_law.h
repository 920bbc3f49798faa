// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::robot {

/// The force by which a potential pushes from what is near, at a distance rho, m:
///
///     F = gain (1/rho' - 1/range) / rho'^2   if rho <= range, else 0;   rho' = max(rho, floor)
///
/// The floor keeps it finite and outward in penetration.
///
/// source Khatib 1986, section 3; report eq. (3.1); docs/theory.md
struct RepulsiveLaw {
  double gain;   ///< N m^3
  double range;  ///< m
  double floor;  ///< m, 0 < floor < range

  /// N
  double Force(double distance) const;
  /// -dF / d(distance), N/m; of the floor below it, as the motion back out would meet it.
  double Slope(double distance) const;
};

}  // namespace oca::robot
