// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run_result.h"

namespace oca::runs {

// A result for whoever is outside: the one place where it becomes JSON.

/// {"min_distance": ..., ...}, all metrics with null where there is no value; {} without metrics.
std::string MetricsJson(const std::optional<systems::MotionMetricsValue>& metrics);
/// [{"name", "value", "bound", "at", "ok"}, ...]
std::string ExpectationsJson(const RunResult& result);
/// All of it, with the diagram's name and file, as `simulator run --json` prints it.
std::string ResultJson(const loading::LoadedDiagram& loaded, const RunResult& result);

}  // namespace oca::runs
