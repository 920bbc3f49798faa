// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/pacer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "oca/framework/dataflow/error.h"

namespace oca {
namespace {

class SteadyClock final : public WallClock {
 public:
  double Now() override {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  }
  void SleepUntil(double time) override {
    const std::chrono::duration<double> since_start(time);
    std::this_thread::sleep_until(
        Clock::time_point(std::chrono::duration_cast<Clock::duration>(since_start)));
  }

 private:
  using Clock = std::chrono::steady_clock;
};

}  // namespace

WallClock& WallClock::Steady() {
  static SteadyClock clock;
  return clock;
}

Pacer::Pacer(double factor, WallClock& clock) : factor_(factor), clock_(clock) {
  if (!std::isfinite(factor) || !(factor > 0.0)) {
    throw ConfigError(
        fmt::format("simulator: realtime_factor; got {}; expected a finite number >= 0", factor));
  }
}

void Pacer::Start(double time) {
  if (started_ && time == last_) return;
  started_ = true;
  simulated_start_ = last_ = time;
  wall_start_ = clock_.Now();
}

void Pacer::WaitFor(double time) {
  last_ = time;
  const double due = wall_start_ + (time - simulated_start_) / factor_;
  const double late = clock_.Now() - due;
  if (late <= 0.0) return clock_.SleepUntil(due);
  ++overruns_;
  worst_overrun_ = std::max(worst_overrun_, late);
}

}  // namespace oca
