// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/models/robot/srdf.h"

class TiXmlElement;

namespace oca::robot {

/// What an SRDF's elements below `root` say, as LoadSrdf has it, after a look at all of them: each
/// element and attribute must be one of MoveIt's format, and what it names must be there. `where`
/// names the file in messages.
/// throws ModelError naming file, line and the nearest name
Srdf ReadSrdf(const TiXmlElement& root, const SrdfRobot& robot, const std::string& where);

}  // namespace oca::robot
