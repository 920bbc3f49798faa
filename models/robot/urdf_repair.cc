// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/urdf_repair_parts.h"
#include "oca/models/robot/xml_numbers.h"

namespace oca::robot {
namespace {

using Names = std::vector<std::string>;

/// Of the elements whose attributes mean something here.
const std::map<std::string, Names>& KnownAttributes() {
  static const std::map<std::string, Names> known{
      {"origin", {"xyz", "rpy", "quat_xyzw"}},
      {"sphere", {"radius"}},
      {"cylinder", {"radius", "length"}},
      {"capsule", {"radius", "length"}},
      {"box", {"size"}},
      {"mesh", {"filename", "scale"}},
      {"axis", {"xyz"}},
      {"mimic", {"joint", "multiplier", "offset"}},
      {"limit", {"lower", "upper", "effort", "velocity", "acceleration", "jerk"}}};
  return known;
}

/// A list of numbers with one blank between two and none around them, as urdfdom wants it. XML 1.0,
/// 3.3.3, takes a tab or a line break for a blank too.
void NormaliseNumbers(TiXmlAttribute& attribute) {
  const std::string text = attribute.Value();
  if (text.find_first_of(" \t\r\n") == text.npos || !ParseFiniteNumbers(text)) return;
  std::istringstream words(text);
  const Names numbers{std::istream_iterator<std::string>(words), {}};
  attribute.SetValue(fmt::format("{}", fmt::join(numbers, " ")));
}

bool NamesSomething(const std::string& attribute) {
  return attribute == "name" || attribute == "link" || attribute == "joint" ||
         attribute == "filename";
}

/// Leaves attributes out that URDF does not have.
void RepairAttributes(TiXmlElement& element, RepairNotes& notes) {
  const auto known = KnownAttributes().find(element.ValueStr());
  Names unknown;
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string name = a->Name();
    if (!NamesSomething(name)) NormaliseNumbers(*a);
    if (name.find(':') != std::string::npos) {
      if (!name.starts_with("xmlns")) unknown.push_back(name);
    } else if (known != KnownAttributes().end() &&
               std::count(known->second.begin(), known->second.end(), name) == 0 &&
               models::MisspeltName(name, known->second).empty()) {
      unknown.push_back(name);
    }
  }
  for (const std::string& name : unknown) {
    notes.Add("attributes that URDF does not have, left out", element,
              fmt::format("'{}' of <{}>", name, element.ValueStr()));
    element.RemoveAttribute(name);
  }
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    RepairAttributes(*e, notes);
  }
}

/// Links that hang on a joint.
std::set<std::string> ChildLinks(const TiXmlElement& root) {
  std::set<std::string> children;
  for (auto* e = root.FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint")) {
    const auto* const child = e->FirstChildElement("child");
    const char* const link = child == nullptr ? nullptr : child->Attribute("link");
    if (link != nullptr) children.insert(link);
  }
  return children;
}

/// Fixes a floating or planar joint below the root link.
void HoldRoot(TiXmlElement& joint, const std::set<std::string>& children, RepairNotes& notes) {
  const char* const text = joint.Attribute("type");
  const std::string type = text == nullptr ? "" : text;
  if (type != "floating" && type != "planar") return;
  const auto* const parent = joint.FirstChildElement("parent");
  const char* const link = parent == nullptr ? nullptr : parent->Attribute("link");
  if (link == nullptr || children.contains(link)) return;
  notes.Add("joints of the root, held where base_pose puts it", joint,
            fmt::format("{} {}", type, QuotedName(joint)));
  joint.SetAttribute("type", "fixed");
}

}  // namespace

std::vector<double> NumbersOrNone(const XmlReader& xml, const TiXmlElement* element,
                                  const char* attribute, int count) {
  if (element == nullptr) return {};
  try {
    return xml.Numbers(*element, attribute, count);
  } catch (const models::ModelError&) {
    return {};
  }
}

WarningLines RepairUrdf(TiXmlElement& root) {
  const XmlReader xml("");  // what it would refuse goes, or is refused where it is read
  RepairNotes notes;
  RepairAttributes(root, notes);
  RepairUrdfMaterials(root, xml, notes);
  const std::set<std::string> children = ChildLinks(root);
  for (auto* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (e->ValueStr() == "link") RepairUrdfLink(*e, xml, notes);
    if (e->ValueStr() == "joint") {
      HoldRoot(*e, children, notes);
      RepairUrdfJoint(*e, xml, notes);
    }
  }
  return notes.Lines();
}

}  // namespace oca::robot
