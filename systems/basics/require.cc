// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/require.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
void RequireAbove(const char* where, double value, double bound) {
  if (value > bound) return;
  throw ConfigError(fmt::format("{}: too small; got {}; expected > {}", where, value, bound));
}

void RequireAtLeast(const char* where, double value, double bound) {
  if (value >= bound) return;
  throw ConfigError(fmt::format("{}: too small; got {}; expected >= {}", where, value, bound));
}

void RequireOrdered(const char* lower_key, const PerComponent& lower, const char* upper_key,
                    const PerComponent& upper) {
  const Eigen::Index lowers = lower.values().size();
  const Eigen::Index uppers = upper.values().size();
  if (!lower.scalar() && !upper.scalar() && lowers != uppers) {
    throw ConfigError(fmt::format("{}: wrong length; got {} numbers; expected {} as in {}",
                                  upper_key, uppers, lowers, lower_key));
  }
  for (Eigen::Index i = 0; i < std::max(lowers, uppers); ++i) {
    if (lower[i] <= upper[i]) continue;
    throw ConfigError(fmt::format("{}: above {}; got {} and {}; expected {} <= {}", lower_key,
                                  upper_key, lower[i], upper[i], lower_key, upper_key));
  }
}

void RequirePositive(const char* where, const Period& value) {
  if (value.positive()) return;
  throw ConfigError(fmt::format("{}: got {}; expected > 0 s", where, value.ToString()));
}

void RequireGain(const char* where, double gain, const Period& period) {
  if (gain * period.seconds() <= 1.0 + std::numeric_limits<double>::epsilon()) return;
  throw ConfigError(fmt::format("{}: got {} 1/s; expected at most 1 / period, {} 1/s", where, gain,
                                1.0 / period.seconds()));
}

}  // namespace oca::systems
