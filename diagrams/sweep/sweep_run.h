// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "oca/diagrams/sweep/campaign.h"
#include "oca/diagrams/sweep/result_file.h"
#include "oca/diagrams/sweep/sample_row.h"

namespace oca::sweep {

struct SweepOptions {
  int jobs{1};                          ///< threads
  std::optional<double> timeout{};      ///< s of the wall clock for a run, building left out
  std::function<bool()> interrupted{};  ///< from any thread; true ends the sweep
  /// A few times a second: runs that are done and that there are.
  std::function<void(std::int64_t done, std::int64_t all)> progress{};
};

/// Builds and runs one sample; whatever goes wrong is in the row. Nothing if it was interrupted.
std::optional<SampleRow> RunSample(const Campaign& campaign, const loading::Blueprint& blueprint,
                                   std::int64_t sample, int combination, const Settings& settings,
                                   const SweepOptions& options, SampleTiming& timing);

/// Number of runs of a shard.
std::int64_t CountRuns(const Campaign& campaign, const Shard& shard);

/// Runs what `file` lacks of the shard, in threads, each sample with a diagram of the campaign's
/// file and a Context of its own, and finishes it. Returns false if it was interrupted; what had
/// ended is kept. throws ConfigError if a result cannot be written.
bool RunSweep(const Campaign& campaign, const loading::Blueprint& blueprint, const Shard& shard,
              const SweepOptions& options, ResultFile& file);

}  // namespace oca::sweep
