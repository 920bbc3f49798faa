// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace oca {

/// An exact span of time in seconds: numerator / denominator, in lowest terms.
///
/// Periods and times of discrete events are rationals, so that 0.1 s meets 0.3 s, and 5 ms meets
/// 1/60 s, exactly and for ever; accumulated doubles would drift apart.
class Period {
 public:
  constexpr Period() = default;
  /// throws ConfigError if `denominator` is not positive.
  Period(std::int64_t numerator, std::int64_t denominator);
  /// The rational with the smallest denominator (at most 10^6) that rounds to `seconds`, else the
  /// whole nanoseconds that do: 0.01 becomes 1/100 and 0.016666666666666666 becomes 1/60.
  /// throws ConfigError if `seconds` is not finite or no such rational exists.
  static Period FromSeconds(double seconds);

  std::int64_t numerator() const { return numerator_; }
  std::int64_t denominator() const { return denominator_; }
  /// Seconds, correctly rounded.
  double seconds() const {
    return static_cast<double>(numerator_) / static_cast<double>(denominator_);
  }
  /// So many of it, correctly rounded where the numbers have 53 bits: the times of ticks.
  double seconds(std::int64_t count) const {
    return static_cast<double>(count * numerator_) / static_cast<double>(denominator_);
  }
  /// How many have gone by at `time`, s: the largest count with seconds(count) <= time. Of a time
  /// that is no tick of some control, or beyond 2^53 of them, none the worse for a rounding.
  std::int64_t CountAt(double time) const;
  /// The first tick after `time`; adding a period to it would miss it by a rounding.
  double TickAfter(double time) const { return seconds(CountAt(time) + 1); }
  bool positive() const { return numerator_ > 0; }
  /// As in `0.01 s` or `1/60 s`.
  std::string ToString() const;

  friend bool operator==(const Period&, const Period&) = default;

 private:
  std::int64_t numerator_{0};
  std::int64_t denominator_{1};
};

}  // namespace oca
