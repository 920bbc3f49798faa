// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace oca::foresight {

/// The times at which motions and obstacles are searched for what moves, from 0 to a duration, s:
/// each millisecond of the first 200 s, and then at most 100,000 more up to the end, as far apart
/// as a share of the time, which is at most 1.1e-4 for the longest run, 1e7 s. So the search of a
/// long run has a bound, and what goes to and fro with one period does not hide between the looks.
class TimeSteps {
 public:
  static constexpr double kStep = 1e-3;        ///< s
  static constexpr double kEachUntil = 200.0;  ///< s

  explicit TimeSteps(double duration)
      : duration_(duration),
        near_(static_cast<long>(std::min(duration, kEachUntil) / kStep)),
        far_(std::clamp(static_cast<long>((duration - kEachUntil) / kStep), 0L, kMostFar)) {}

  long size() const { return near_ + far_ + 1; }
  /// Grows with `step`, from 0.
  double operator[](long step) const {
    if (step <= near_) return static_cast<double>(step) * kStep;
    const double share = static_cast<double>(step - near_) / static_cast<double>(far_);
    return kEachUntil * std::pow(duration_ / kEachUntil, share);
  }

 private:
  static constexpr long kMostFar = 100'000;

  double duration_;
  long near_, far_;
};

}  // namespace oca::foresight
