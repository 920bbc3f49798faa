// SPDX-License-Identifier: BSD-3-Clause
// What RepairUrdf does below links, and of materials.
#include <tinyxml.h>

#include <algorithm>
#include <set>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/robot/urdf_repair_parts.h"
#include "oca/models/robot/urdf_shape.h"

namespace oca::robot {
namespace {

constexpr const char* kNoColour =
    "materials whose colour is not four numbers from 0 to 1, left out";
constexpr const char* kNoName = "materials without a name, left out";

bool HasName(const TiXmlElement& material) {
  const char* const name = material.Attribute("name");
  return name != nullptr && *name != '\0';
}

bool SaysColour(const XmlReader& xml, const TiXmlElement& material) {
  const auto rgba = NumbersOrNone(xml, material.FirstChildElement("color"), "rgba", 4);
  return !rgba.empty() && std::all_of(rgba.begin(), rgba.end(),
                                      [](double part) { return part >= 0.0 && part <= 1.0; });
}

/// The first one with a colour that is one counts; one without is the robot's of that name.
void RepairMaterialsOf(TiXmlElement& solid, const std::string& link, const XmlReader& xml,
                       RepairNotes& notes) {
  bool found = false;
  for (auto* e = solid.FirstChildElement("material"); e != nullptr;) {
    auto* const next = e->NextSiblingElement("material");
    if (!HasName(*e)) {
      notes.Drop(solid, *e, kNoName, "of link " + link);
    } else if (e->FirstChildElement("color") != nullptr && !SaysColour(xml, *e)) {
      notes.Drop(solid, *e, kNoColour, "of link " + link);
    } else if (std::exchange(found, true)) {
      notes.Drop(solid, *e, "materials beside another one, left out", "of link " + link);
    }
    e = next;
  }
}

bool CanBeDrawn(const XmlReader& xml, const TiXmlElement& visual) {
  try {
    CheckUrdfOrigin(xml, visual);
    CheckUrdfGeometry(xml, visual);
    return true;
  } catch (const models::ModelError&) {
    return false;
  }
}

bool SaysInertia(const XmlReader& xml, const TiXmlElement& inertial) {
  if (const auto* const origin = inertial.FirstChildElement("origin")) {
    if (origin->Attribute("quat_xyzw") != nullptr) return false;  // a wrong one
    for (const char* part : {"xyz", "rpy"}) {
      const bool said = origin->Attribute(part) != nullptr;
      if (said && NumbersOrNone(xml, origin, part, 3).empty()) return false;
    }
  }
  const auto kilograms = NumbersOrNone(xml, inertial.FirstChildElement("mass"), "value", 1);
  if (kilograms.empty() || kilograms.front() < 0.0) return false;
  const auto* const inertia = inertial.FirstChildElement("inertia");
  for (const char* entry : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) {
    if (NumbersOrNone(xml, inertia, entry, 1).empty()) return false;
  }
  return true;
}

}  // namespace

void RepairUrdfLink(TiXmlElement& link, const XmlReader& xml, RepairNotes& notes) {
  const std::string name = QuotedName(link);
  for (auto* e = link.FirstChildElement(); e != nullptr;) {
    auto* const next = e->NextSiblingElement();
    const std::string& kind = e->ValueStr();
    if (kind == "visual" && !CanBeDrawn(xml, *e)) {
      notes.Drop(link, *e, "visuals without a place, a shape or its size, not drawn",
                 "of link " + name);
    } else if (kind == "visual" || kind == "collision") {
      RepairMaterialsOf(*e, name, xml, notes);
    } else if (kind == "inertial" && !SaysInertia(xml, *e)) {
      notes.Drop(link, *e, "inertias that are incomplete, no numbers or of negative mass, left out",
                 "of link " + name);
    }
    e = next;
  }
}

void RepairUrdfMaterials(TiXmlElement& robot, const XmlReader& xml, RepairNotes& notes) {
  std::set<std::string> names;
  for (auto* e = robot.FirstChildElement("material"); e != nullptr;) {
    auto* const next = e->NextSiblingElement("material");
    const auto* const texture = e->FirstChildElement("texture");
    const bool textured = texture != nullptr && texture->Attribute("filename") != nullptr;
    const bool coloured = e->FirstChildElement("color") != nullptr;
    if (!HasName(*e)) {
      notes.Drop(robot, *e, kNoName, "of the robot");
    } else if ((coloured || !textured) && !SaysColour(xml, *e)) {
      notes.Drop(robot, *e, kNoColour, QuotedName(*e));
    } else if (!names.insert(QuotedName(*e)).second) {
      notes.Drop(robot, *e, "materials that are there already, left out", QuotedName(*e));
    }
    e = next;
  }
}

}  // namespace oca::robot
