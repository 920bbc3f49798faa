// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/robot/warning_lines.h"

class TiXmlElement;

namespace oca::robot {

/// Takes out of a URDF document, below `root`, what is wrong in it and that nothing here reads, so
/// that a robot is not refused for it: attributes that URDF does not have, visuals without a
/// place, a shape or its size, materials that are said twice, without a name or a colour that is
/// one, inertias that are incomplete, no numbers or of negative mass, dynamics, calibrations and
/// gains of safety controllers that are no numbers, limits and axes of fixed joints. A floating or
/// planar joint below the root link becomes a fixed one: where the robot stands is said elsewhere.
/// A limit of the effort that is missing, no number or below 0 becomes 0, which means none
/// (LimitWarnings); one end of a range that is missing becomes 0, which URDF means. An attribute
/// within two letters of one of URDF's stays, to be refused as a slip of the pen.
///
/// Returns what was done: `attributes that URDF does not have, left out: 'a:b' of <origin> of link
/// 'upper' (line 12), ... and 20 more`.
WarningLines RepairUrdf(TiXmlElement& root);

}  // namespace oca::robot
