// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/svg_plot.h"

namespace oca::tools {

/// The ready-made figures of `simulator plot --figure`.
std::vector<std::string> FigureNames();

/// A figure of the 2016 report, from our own runs of its tests: `report-3.5` the repulsive force,
/// `report-4.1` the static test without a limit on the deltas, `report-4.2` with it.
std::vector<record::PlotPanel> FigurePanels(const std::string& name);

}  // namespace oca::tools
