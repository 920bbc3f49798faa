// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/sweep/campaign.h"
#include "oca/diagrams/sweep/result_file.h"
#include "oca/diagrams/sweep/statistics.h"

namespace oca::sweep {

/// What one run was like; empty where its metrics do not tell. A run that did not finish was not
/// free of contact and did not arrive.
struct Verdict {
  /// certified_min_distance > 0 if there is one, thus at every time; else as `sampled_clear`.
  std::optional<bool> clear;
  /// min_distance > 0, or of what was looked at nothing ever came within reach; at the control
  /// ticks.
  std::optional<bool> sampled_clear;
  std::optional<bool> arrived;  ///< final_error <= arrival of the campaign
  std::optional<bool> both;     ///< clear and arrived
  bool met{false};              ///< finished, with all expectations met
};
Verdict Judge(const SampleRow& row, double arrival);

/// How many of the runs of which it is known.
struct Share {
  std::int64_t count{0};
  std::int64_t of{0};
  ConfidenceInterval interval() const {
    return WilsonInterval(static_cast<std::size_t>(count), static_cast<std::size_t>(of));
  }
};

/// A metric over the runs that finished and have it.
struct Spread {
  std::int64_t count{0};
  double median{0.0};
  ConfidenceInterval interval{0.0, 0.0};  ///< of the median
  double worst{0.0};  ///< the least of what should be large, the largest of the rest
  std::int64_t worst_sample{0};
};

struct CombinationSummary {
  Settings settings;
  std::int64_t runs{0};
  std::int64_t unfinished{0};
  Share clear, sampled_clear, arrived, both, met;
  Share within_limits;  ///< runs without a limit_violations
  Spread min_distance, final_error, reversals, path_ratio, time_to_goal, max_delta,
      limit_violations;
  StepTimes steps;
};

/// A run that did not finish, was not clear, did not arrive or did not meet an expectation.
struct Failure {
  std::int64_t sample;
  int combination;
  int seed;
  std::string why;
  std::string command;  ///< runs it alone
};

struct Summary {
  std::vector<CombinationSummary> combinations;
  std::vector<Failure> failures;  ///< in the order of the rows
  std::int64_t unfinished{0};
  std::int64_t unmet{0};  ///< runs that finished and did not meet an expectation
};
Summary Summarize(const Results& results);

/// Why the run counts as a failure; empty if it does not.
std::string FailureOf(const SampleRow& row, double arrival);

}  // namespace oca::sweep
