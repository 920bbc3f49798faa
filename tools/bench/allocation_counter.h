// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "tests/allocation_count.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(text) static_cast<void>(text)
#endif

namespace oca::bench {

/// Gives a benchmark the counter `allocations`, those an iteration, from here to the end of scope.
/// Under callgrind it also dumps the instructions in between, with the number of iterations.
class AllocationCounter {
 public:
  explicit AllocationCounter(benchmark::State& state) : state_(state), start_(AllocationCount()) {
    CALLGRIND_ZERO_STATS;
  }
  ~AllocationCounter() {
    CALLGRIND_DUMP_STATS_AT(std::to_string(state_.iterations()).c_str());
    state_.counters["allocations"] = benchmark::Counter(
        static_cast<double>(AllocationCount() - start_), benchmark::Counter::kAvgIterations);
  }
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

 private:
  benchmark::State& state_;
  std::int64_t start_;
};

}  // namespace oca::bench
