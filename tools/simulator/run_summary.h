// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/runs/run.h"

namespace oca::tools {

/// What a person wants to know of a run, in a few lines: clear or not and where it was closest,
/// goal reached or not, how the motion was altered, expectations, time.
std::string RunSummary(const loading::LoadedDiagram& loaded, const runs::RunResult& result,
                       bool colour);

/// What each system took, the most costly first, and what is left for the engine, the integrator
/// and the record; empty unless it was measured.
std::string ProfileTable(const runs::RunResult& result);

}  // namespace oca::tools
