// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/svg_plot.h"

namespace oca::record {

/// The figures of the 2016 report that FigurePanels knows.
std::vector<std::string> FigureNames();

/// A figure of the 2016 report, from our own runs of its tests: `report-3.5` the repulsive force,
/// `report-4.1` the static test without a limit on the deltas, `report-4.2` with it.
/// throws ConfigError if there is no such figure, or the diagrams that come with OCA are not there.
std::vector<PlotPanel> FigurePanels(const std::string& name);

}  // namespace oca::record
