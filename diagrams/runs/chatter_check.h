// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::runs {

/// Warnings about loops of avoidance that must chatter with their settings, a line each with its
/// place: the gain g, where, and the relaxation time that they need. A loop is,
/// in the roles that its systems declare,
///
///     Kinematics -> ... field -> ... -> MapsForces -> CarriesDelta -> ... -> AddsDelta
///
/// It is looked at without running it: at samples of the requested motion, obstacles where their
/// script has them then, the delta is led to where the loop would rest, and the gain taken there
/// (systems::MapsForces). More than 2 relaxation_time / period - 1 there means that the rest is not
/// stable. What adapts to its gain and what is not `enabled` gives no warning; neither
/// does a loop of other make.
std::vector<std::string> ChatterWarnings(const loading::LoadedDiagram& loaded);

}  // namespace oca::runs
