// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/sweep/result_file.h"
#include "oca/diagrams/sweep/summary.h"

namespace oca::sweep {

/// What tells a combination from the others, as `avoidance=report`.
std::string TitleOf(const Settings& settings);

/// The campaign, its measures and all failures as one JSON object.
std::string SummaryJson(const Results& results, const Summary& summary);

}  // namespace oca::sweep
