// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/record/svg_plot.h"

namespace oca::record {

/// Recorded signals over time: a panel a pattern, as ReadSeries takes them, with the curves of all
/// records, those of a further one dashed.
/// throws ConfigError if a record cannot be read, or nothing matches a pattern.
std::vector<PlotPanel> SignalPanels(const std::vector<std::string>& records,
                                    const std::vector<std::string>& patterns);

/// Writes panels as .svg or .png, the latter by librsvg's rsvg-convert, two pixels a unit.
/// throws ConfigError if the file is of another kind or cannot be written.
void WritePlot(const std::filesystem::path& file, const std::vector<PlotPanel>& panels);

}  // namespace oca::record
