// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "diagrams/loader.h"

namespace oca::diagrams {

/// Whether a MotionMetrics of the file is given distances.
bool JudgesDistances(const LoadedDiagram& loaded);

/// What the distances that a run is judged by do not look at, so that nobody takes it for clear, a
/// phrase each: links without a collision shape, own links, other models, pairs of `ignore`,
/// obstacles that a sensor alone reports. Of every BulletDistance that drives the `proximities` of
/// a MotionMetrics; what drives them otherwise is not known.
std::vector<std::string> BlindSpots(const LoadedDiagram& loaded);

}  // namespace oca::diagrams
