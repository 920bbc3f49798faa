// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "oca/models/robot/srdf.h"

class TiXmlElement;

namespace oca::robot {

/// The pairs that an SRDF's elements below `root` disable, as LoadDisabledPairs has them, after a
/// look at all of them: each element and attribute must be one of MoveIt's format, and what it
/// names must be there. `where` names the file in messages.
/// throws ModelError naming file, line and the nearest name
std::vector<std::pair<int, int>> ReadSrdf(const TiXmlElement& root, const SrdfRobot& robot,
                                          const std::string& where);

}  // namespace oca::robot
