// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "oca/diagrams/foresight/foresight.h"

namespace oca::foresight {

/// Length of the shortest way of the joints from the start to the end of the request that ten
/// searches find (planning::ShortestPath, seeds 0 to 9, `seconds` each), 1 mm from everything: the
/// 2-norms, rad or m. None if a body moves, or no search finds one.
std::optional<double> ReferenceLength(const Foresight& scene, double seconds);

}  // namespace oca::foresight
