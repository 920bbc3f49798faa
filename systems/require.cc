// SPDX-License-Identifier: BSD-3-Clause
#include "systems/require.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "framework/error.h"

namespace oca::systems {
namespace {

std::string At(const char* where, const PerComponent& value, Eigen::Index i) {
  return value.scalar() ? where : fmt::format("{}[{}]", where, i);
}

}  // namespace

void RequireFinite(const char* where, const PerComponent& value) {
  if (value.values().size() == 0) {
    throw ConfigError(fmt::format("{}: empty; got no number; expected at least one", where));
  }
  for (Eigen::Index i = 0; i < value.values().size(); ++i) {
    if (std::isfinite(value[i])) continue;
    throw ConfigError(fmt::format("{}: not finite; got {}; expected a finite number",
                                  At(where, value, i), value[i]));
  }
}

void RequireAbove(const char* where, const PerComponent& value, double bound) {
  RequireFinite(where, value);
  for (Eigen::Index i = 0; i < value.values().size(); ++i) {
    if (value[i] > bound) continue;
    throw ConfigError(
        fmt::format("{}: too small; got {}; expected > {}", At(where, value, i), value[i], bound));
  }
}

void RequireAtLeast(const char* where, const PerComponent& value, double bound) {
  RequireFinite(where, value);
  for (Eigen::Index i = 0; i < value.values().size(); ++i) {
    if (value[i] >= bound) continue;
    throw ConfigError(
        fmt::format("{}: too small; got {}; expected >= {}", At(where, value, i), value[i], bound));
  }
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

void RequireNotNegative(const char* where, const Period& value) {
  if (value.numerator() >= 0) return;
  throw ConfigError(fmt::format("{}: got {}; expected >= 0 s", where, value.ToString()));
}

}  // namespace oca::systems
