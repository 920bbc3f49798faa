// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "oca/diagrams/sweep/result_file.h"

namespace oca::sweep {

/// Puts the shards of a folder together, `shard-*-of-*.jsonl`, or reads `results.jsonl` if there
/// are none: the same as one process that had run all samples.
/// throws ConfigError with all that is wrong, a line each: shards of different campaigns or
/// divisions, shards that are not finished, runs that are missing or there twice.
Results MergeShards(const std::filesystem::path& folder);

}  // namespace oca::sweep
