// SPDX-License-Identifier: BSD-3-Clause
// What RepairUrdf does below joints.
#include <fmt/format.h>
#include <tinyxml.h>

#include <tuple>

#include "oca/models/robot/urdf_repair_parts.h"

namespace oca::robot {
namespace {

std::string TypeOf(const TiXmlElement& joint) {
  const char* const type = joint.Attribute("type");
  return type == nullptr ? "" : type;
}

/// At least one, which urdfdom wants, and nothing that is none.
bool SaysNumbers(const XmlReader& xml, const TiXmlElement& element) {
  if (element.FirstAttribute() == nullptr) return false;
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (NumbersOrNone(xml, &element, a->Name(), 1).empty()) return false;
  }
  return true;
}

/// urdfdom wants the gains, which nothing here reads; soft limits are told (UrdfReader).
void FillGains(TiXmlElement& controller, const TiXmlElement& joint, const XmlReader& xml,
               RepairNotes& notes) {
  for (const std::string what :
       {"k_velocity", "k_position", "soft_lower_limit", "soft_upper_limit"}) {
    if (!NumbersOrNone(xml, &controller, what.c_str(), 1).empty()) continue;
    if (controller.Attribute(what) == nullptr && what != "k_velocity") continue;
    notes.Add("numbers of safety_controllers that are none, left out", controller,
              fmt::format("{} of joint {}", what, QuotedName(joint)));
    controller.RemoveAttribute(what);
    if (what == "k_velocity") controller.SetAttribute(what, "0");
  }
}

/// An end of the range that is left out is 0, if the other is there. A range that would end before
/// it begins is none: what is missing is told (ReadUrdfOutline).
void FillRange(TiXmlElement& limit, const TiXmlElement& joint, const XmlReader& xml,
               RepairNotes& notes) {
  for (const auto& [end, other, sign] :
       {std::tuple("lower", "upper", 1.0), std::tuple("upper", "lower", -1.0)}) {
    const auto there = NumbersOrNone(xml, &limit, other, 1);
    if (limit.Attribute(end) != nullptr || there.empty() || sign * there.front() < 0.0) continue;
    notes.Add("limits that say one end of the range, 0 at the other", limit,
              fmt::format("no {} of joint {}", end, QuotedName(joint)));
    limit.SetAttribute(end, "0");
  }
}

/// No effort, and no velocity, which urdfdom wants, is one of 0: not given (LimitWarnings).
void FillLimit(TiXmlElement& joint, const XmlReader& xml, RepairNotes& notes) {
  auto* const limit = joint.FirstChildElement("limit");
  if (limit == nullptr) return;
  if (TypeOf(joint) != "" && TypeOf(joint) != "continuous") FillRange(*limit, joint, xml, notes);
  if (limit->Attribute("velocity") == nullptr) limit->SetAttribute("velocity", "0");
  const auto effort = NumbersOrNone(xml, limit, "effort", 1);
  if (!effort.empty() && effort.front() >= 0.0) return;
  if (const char* const text = limit->Attribute("effort")) {
    notes.Add("efforts that are no number or below 0, left out", *limit,
              fmt::format("'{}' of joint {}", text, QuotedName(joint)));
  }
  limit->SetAttribute("effort", "0");
}

}  // namespace

void RepairUrdfJoint(TiXmlElement& joint, const XmlReader& xml, RepairNotes& notes) {
  for (auto* e = joint.FirstChildElement(); e != nullptr;) {
    auto* const next = e->NextSiblingElement();
    const std::string& kind = e->ValueStr();
    const std::string which = fmt::format("<{}> of joint {}", kind, QuotedName(joint));
    if (kind == "dynamics" || kind == "calibration") {
      if (!SaysNumbers(xml, *e)) {
        notes.Drop(joint, *e, "dynamics and calibrations that are no numbers, left out", which);
      } else if (e != joint.FirstChildElement(kind)) {
        notes.Drop(joint, *e, "elements that are there already, left out", which);
      }
    } else if (kind == "safety_controller") {
      FillGains(*e, joint, xml, notes);
    } else if (TypeOf(joint) == "fixed" && (kind == "limit" || kind == "axis")) {
      joint.RemoveChild(e);  // they mean nothing there
    }
    e = next;
  }
  FillLimit(joint, xml, notes);
}

}  // namespace oca::robot
