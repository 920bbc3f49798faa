// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/svg_plot.h"

namespace oca::sweep {

/// `method-comparison`: what the combinations of sweeps reached, a folder of results each. Two
/// panels a sweep: the share of all runs that came no nearer than a distance, and the share that
/// had reached the goal by a time; both end at the share that failed or never arrived.
/// throws ConfigError if a folder holds no results, or no run of it finished.
std::vector<record::PlotPanel> MethodPanels(const std::vector<std::string>& folders);

}  // namespace oca::sweep
