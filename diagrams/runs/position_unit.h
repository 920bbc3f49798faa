// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/loading/loader.h"

namespace oca::runs {

/// "rad", "m" or "rad or m": what metrics of joint positions are in. Of the robots that the judges
/// name; of all that move, if one names none.
std::string PositionUnit(const loading::LoadedDiagram& loaded);

/// The same over a power of time, "rad/s or m/s".
std::string UnitOverTime(const std::string& unit, const std::string& time);

}  // namespace oca::runs
