// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "oca/diagrams/sweep/campaign.h"
#include "oca/diagrams/sweep/step_times.h"
#include "oca/systems/signals/motion_metrics_value.h"

namespace oca::sweep {

/// How the run of a sample ended.
enum class Outcome {
  kFinished,
  kFailed,     ///< in a calculation
  kNotLoaded,  ///< the diagram is wrong with this seed
  kTimedOut,   ///< took too long
  kCrashed,    ///< ended the program
};
const char* NameOf(Outcome outcome);

/// The result of one run: nothing in it depends on the machine's speed, but for a time-out. JSON:
/// {"sample", "combination", "seed", "set", "outcome", "error", "duration", "steps", "metrics",
/// "unmet"}, a line of a results file.
struct SampleRow {
  std::int64_t sample{0};
  int combination{0};
  int seed{0};
  Settings set;  ///< of the combination, and what was drawn
  Outcome outcome{Outcome::kFinished};
  std::string error;  ///< empty if it finished
  double duration{0.0};
  std::int64_t steps{0};
  std::optional<systems::MotionMetricsValue> metrics;  ///< of all judges as one
  std::vector<std::string> unmet;                      ///< expectations that were not met

  std::tuple<std::int64_t, int> key() const { return {sample, combination}; }
  std::string Line() const;
  /// throws ConfigError if it is none.
  static SampleRow FromLine(std::string_view line);
};

/// What the run cost here and now. JSON: {"sample", "combination", "load_seconds", "run_seconds",
/// "step_max", "step_classes": [[class, steps], ...]}, a line of a timings file.
struct SampleTiming {
  std::int64_t sample{0};
  int combination{0};
  double load_seconds{0.0};
  double run_seconds{0.0};
  StepTimes steps;

  std::tuple<std::int64_t, int> key() const { return {sample, combination}; }
  std::string Line() const;
  /// throws ConfigError if it is none.
  static SampleTiming FromLine(std::string_view line);
};

}  // namespace oca::sweep
