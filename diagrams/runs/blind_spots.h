// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::runs {

/// Whether a judge of the file is given distances.
bool JudgesDistances(const loading::LoadedDiagram& loaded);

/// What the distances that a run is judged by do not look at, so that nobody takes it for clear, a
/// phrase each: what the blocks from which a judge's `proximities` come say of themselves, and
/// those that they see through (systems::BlindSpots), whatever passes values on in between: links
/// without a collision shape, own links, other models, pairs of `ignore`, obstacles that a sensor
/// alone reports. A robot is named where the diagram has several.
std::vector<std::string> BlindSpots(const loading::LoadedDiagram& loaded);

}  // namespace oca::runs
