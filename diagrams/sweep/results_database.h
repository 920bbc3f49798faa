// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "oca/diagrams/sweep/result_file.h"

namespace oca::sweep {

/// Writes results as an SQLite database, in place of one that is there:
///
///     campaign(key, value)                          one row a property, as in the results file
///     setting(combination, path, value)             listed values of each combination
///     sample(sample, combination, seed, outcome, error, duration, steps, clear, sampled_clear,
///            arrived, met, failure, command)        one row a run; 0, 1 or null as Verdict says
///     drawn(sample, path, value)                    what the sample's seed drew
///     metric(sample, combination, name, value)      numbers, texts as JSON; null is left out
///     timing(sample, combination, load_seconds, run_seconds, step_p50, step_p99, step_max)
///
/// throws ConfigError if it cannot be written.
void WriteDatabase(const std::filesystem::path& file, const Results& results);

}  // namespace oca::sweep
