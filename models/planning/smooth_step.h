// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace oca::planning {

/// From 0 at s <= 0 to 1 at s >= 1, its first and second derivative zero at both ends:
///
///     6 s^5 - 15 s^4 + 10 s^3
inline double SmoothStep(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

}  // namespace oca::planning
