// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace oca {

/// A clock on the wall that one can wait for; s from any start.
class WallClock {
 public:
  virtual ~WallClock() = default;
  virtual double Now() = 0;
  virtual void SleepUntil(double time) = 0;
  /// The machine's steady clock.
  static WallClock& Steady();
};

/// Holds simulated time to wall-clock time: `factor` simulated seconds in each second. Time that
/// was lost is made up for, never forgotten.
class Pacer {
 public:
  /// throws ConfigError unless `factor` is finite and positive.
  Pacer(double factor, WallClock& clock);

  /// A run goes on at simulated `time`, s. If it was waited for last, the schedule stays.
  void Start(double time);
  /// Sleeps until simulated `time`, s, is due. If that is past, it is an overrun.
  void WaitFor(double time);

  std::int64_t overruns() const { return overruns_; }
  double worst_overrun() const { return worst_overrun_; }  ///< s of wall clock

 private:
  const double factor_;
  WallClock& clock_;
  bool started_{false};
  double simulated_start_{0.0}, wall_start_{0.0};
  double last_{0.0};  // simulated time that was waited for
  std::int64_t overruns_{0};
  double worst_overrun_{0.0};
};

}  // namespace oca
