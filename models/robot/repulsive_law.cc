// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/repulsive_law.h"

#include <algorithm>

namespace oca::robot {

double RepulsiveLaw::Force(double distance) const {
  if (distance > range) return 0.0;
  const double rho = std::max(distance, floor);
  return gain * (1.0 / rho - 1.0 / range) / (rho * rho);
}

double RepulsiveLaw::Slope(double distance) const {
  if (distance > range) return 0.0;
  const double rho = std::max(distance, floor);
  return gain * (3.0 / rho - 2.0 / range) / (rho * rho * rho);
}

}  // namespace oca::robot
