// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/sweep/result_file.h"
#include "oca/diagrams/sweep/summary.h"

namespace oca::tools {

/// A table of measures by combinations, with confidence intervals of 95 %, and the first failures
/// with the command line that runs each alone.
std::string SweepTable(const sweep::Results& results, const sweep::Summary& summary, bool colour);

/// The measures as a table of Markdown, a line a combination.
std::string SweepMarkdown(const sweep::Results& results, const sweep::Summary& summary);

}  // namespace oca::tools
