// SPDX-License-Identifier: BSD-3-Clause
// The parts of RepairUrdf: see there.
#pragma once

#include "oca/models/robot/repair_notes.h"
#include "oca/models/robot/xml_reader.h"

namespace oca::robot {

/// Below a link: visuals, their materials and inertias that nothing can use.
void RepairUrdfLink(TiXmlElement& link, const XmlReader& xml, RepairNotes& notes);
/// Materials of the robot that are no colours, or said twice.
void RepairUrdfMaterials(TiXmlElement& robot, const XmlReader& xml, RepairNotes& notes);
/// Below a joint: what is no number and nothing reads, and what a limit leaves out.
void RepairUrdfJoint(TiXmlElement& joint, const XmlReader& xml, RepairNotes& notes);

/// `count` finite numbers; nothing if the attribute, or the element, is absent or something else.
std::vector<double> NumbersOrNone(const XmlReader& xml, const TiXmlElement* element,
                                  const char* attribute, int count);

}  // namespace oca::robot
