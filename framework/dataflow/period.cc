// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/period.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "oca/framework/dataflow/error.h"

namespace oca {

Period::Period(std::int64_t numerator, std::int64_t denominator) {
  if (denominator <= 0) {
    throw ConfigError(fmt::format("period: denominator; got {}; expected > 0", denominator));
  }
  const std::int64_t divisor = std::gcd(numerator, denominator);
  numerator_ = numerator / divisor;
  denominator_ = denominator / divisor;
}

namespace {

constexpr double kNanosecondsPerSecond = 1e9;

/// Two roundings (the division in the file and this one) may each cost half a unit.
bool Rounds(double ratio, double seconds) {
  return std::fabs(ratio - seconds) <= 2.3e-16 * std::fabs(seconds);
}

}  // namespace

Period Period::FromSeconds(double seconds) {
  constexpr double kLargest = 1e9;
  if (!std::isfinite(seconds) || std::fabs(seconds) > kLargest) {
    throw ConfigError(
        fmt::format("period: got {}; expected a finite number of seconds up to 1e9", seconds));
  }
  // Convergents p/q of the continued fraction: the first that rounds to `seconds` is the simplest.
  // Beyond the limit several ratios round to one double, and which was meant cannot be known.
  constexpr double kLargestDenominator = 1e6;
  const double magnitude = std::fabs(seconds);
  double rest = magnitude;
  double p0 = 0.0, q0 = 1.0, p1 = 1.0, q1 = 0.0;
  for (int i = 0; i < 64; ++i) {
    const double whole = std::floor(rest);
    const double p2 = whole * p1 + p0;
    const double q2 = whole * q1 + q0;
    if (q2 > kLargestDenominator) break;
    if (Rounds(p2 / q2, magnitude)) {
      const auto numerator = static_cast<std::int64_t>(p2);
      return Period(seconds < 0 ? -numerator : numerator, static_cast<std::int64_t>(q2));
    }
    p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    if (rest == whole) break;
    rest = 1.0 / (rest - whole);
  }
  const double nanoseconds = std::round(seconds * kNanosecondsPerSecond);
  if (nanoseconds != 0.0 && Rounds(nanoseconds / kNanosecondsPerSecond, seconds)) {
    return Period(static_cast<std::int64_t>(nanoseconds),
                  static_cast<std::int64_t>(kNanosecondsPerSecond));
  }
  throw ConfigError(fmt::format(
      "period: got {:.17g} s; expected a ratio of integers with a denominator up to 1e6, or whole "
      "nanoseconds",
      seconds));
}

std::int64_t Period::CountAt(double time) const {
  constexpr double kMost = 9007199254740992.0;  // 2^53
  const double most = std::floor(kMost / static_cast<double>(numerator_));
  auto count = static_cast<std::int64_t>(std::clamp(std::floor(time / seconds()), -most, most));
  // The quotient may miss a whole number by a rounding, no more.
  if (seconds(count) > time) --count;
  if (seconds(count + 1) <= time) ++count;
  return count;
}

std::string Period::ToString() const {
  const std::int64_t q = denominator_;
  std::int64_t rest = q;
  while (rest % 2 == 0) rest /= 2;
  while (rest % 5 == 0) rest /= 5;
  if (rest == 1) return fmt::format("{} s", seconds());
  return fmt::format("{}/{} s", numerator_, q);
}

}  // namespace oca
