// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/event_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "oca/framework/dataflow/error.h"

namespace oca {
namespace {

/// Ticks of the common clock up to which a double divided by a double is the nearest time.
constexpr std::int64_t kMostTicks = std::int64_t{1} << 53;
/// The clock stays exact at least so long: more than a day.
constexpr std::int64_t kLeastSeconds = 100000;

std::int64_t Ticks(const Period& period, std::int64_t rate) {
  // The rate is a multiple of every denominator.
  const std::int64_t factor = std::max<std::int64_t>(rate / period.denominator(), 1);
  if (std::abs(period.numerator()) > kMostTicks / factor) {
    throw ConfigError(
        fmt::format("simulator: period; got {}; expected at most {} s beside the others",
                    period.ToString(), kMostTicks / rate));
  }
  return period.numerator() * factor;
}

}  // namespace

void EventClock::Add(const Every& every) {
  std::int64_t rate = rate_;
  for (const std::int64_t denominator : {every.period.denominator(), every.offset.denominator()}) {
    const std::int64_t factor = denominator / std::gcd(rate, denominator);
    if (factor > kMostTicks / kLeastSeconds / rate) {
      throw ConfigError(fmt::format(
          "simulator: period; got {}, which shares no clock with the others; expected periods "
          "with small common multiples",
          every.period.ToString()));
    }
    rate *= factor;
  }
  std::vector<Every> everies = everies_;
  everies.push_back(every);
  std::vector<Beat> beats;
  beats.reserve(everies.size());
  for (const Every& each : everies) {
    beats.push_back({Ticks(each.offset, rate), Ticks(each.period, rate)});
  }
  rate_ = rate;
  everies_ = std::move(everies);
  beats_ = std::move(beats);
}

std::int64_t EventClock::FirstCount(std::size_t beat, double time) const {
  const double ticks = time * static_cast<double>(rate_);
  if (!(std::fabs(ticks) <= static_cast<double>(kMostTicks))) {
    throw ConfigError(
        fmt::format("simulator: time; got {} s; expected at most {} s", time, kMostTicks / rate_));
  }
  auto count =
      static_cast<std::int64_t>(std::floor((ticks - static_cast<double>(beats_[beat].offset)) /
                                           static_cast<double>(beats_[beat].period)));
  count = std::max<std::int64_t>(count - 1, 0);
  while (Time(beat, count) < time) ++count;
  return count;
}

std::int64_t EventClock::Follow(std::size_t beat, std::int64_t count, double time) const {
  const bool behind = Time(beat, count) < time;
  const bool ahead = count > 0 && Time(beat, count - 1) > time;
  return behind || ahead ? FirstCount(beat, time) : count;
}

}  // namespace oca
