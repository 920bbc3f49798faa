// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/warning_lines.h"

namespace oca::robot {

/// Why no body can have an inertia: a principal moment below 0, or above the sum of the other two;
/// empty if one can, or if the mass is 0. What three digits in a file can take from the others, 0.2
/// % of the largest moment, counts as rounding.
/// source Featherstone, Rigid Body Dynamics Algorithms, section 2.13
std::string ImpossibleInertia(const Inertia& inertia);

/// Lines about the links whose inertias no body can have. Nothing that avoids obstacles reads
/// inertias.
WarningLines InertiaWarnings(const RobotModel& model);

}  // namespace oca::robot
