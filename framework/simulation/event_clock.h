// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "oca/framework/dataflow/system.h"

namespace oca {

/// All periods and offsets as whole ticks of one clock, whose rate is their least common multiple:
/// times of events are quotients, never sums. A beat is what was added, by its number; beat b
/// happens for the count-th time (from 0) at offset + count period.
class EventClock {
 public:
  /// throws ConfigError if the period shares no clock with the others that stays exact for a day,
  /// or is too long for it
  void Add(const Every& every);
  /// s
  double Time(std::size_t beat, std::int64_t count) const {
    return static_cast<double>(beats_[beat].offset + count * beats_[beat].period) /
           static_cast<double>(rate_);
  }
  /// The first count whose time is not before `time`. throws ConfigError if that is too far away
  std::int64_t FirstCount(std::size_t beat, double time) const;
  /// `count` as long as `time` lies between it and the one before; else the first not before
  /// `time`.
  std::int64_t Follow(std::size_t beat, std::int64_t count, double time) const;

 private:
  struct Beat {
    std::int64_t offset;
    std::int64_t period;
  };

  std::int64_t rate_{1};  // ticks a second
  std::vector<Every> everies_;
  std::vector<Beat> beats_;
};

}  // namespace oca
