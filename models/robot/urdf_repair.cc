// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "oca/models/nearest_name.h"
#include "oca/models/robot/xml_numbers.h"

namespace oca::robot {
namespace {

using Names = std::vector<std::string>;

/// Of the elements whose attributes mean something here.
const std::map<std::string, Names>& KnownAttributes() {
  static const std::map<std::string, Names> known{
      {"origin", {"xyz", "rpy"}},
      {"sphere", {"radius"}},
      {"cylinder", {"radius", "length"}},
      {"box", {"size"}},
      {"mesh", {"filename", "scale"}},
      {"axis", {"xyz"}},
      {"mimic", {"joint", "multiplier", "offset"}},
      {"limit", {"lower", "upper", "effort", "velocity", "acceleration", "jerk"}}};
  return known;
}

/// `count` finite numbers; nothing if the text is something else.
std::optional<std::vector<double>> NumbersOf(const TiXmlElement* element, const char* attribute,
                                             std::size_t count) {
  const char* const text = element == nullptr ? nullptr : element->Attribute(attribute);
  if (text == nullptr) return std::nullopt;
  auto numbers = ParseFiniteNumbers(text);
  if (numbers && numbers->size() != count) return std::nullopt;
  return numbers;
}

constexpr const char* kNoColour =
    "materials whose colour is not four numbers from 0 to 1, left out";
constexpr const char* kNoName = "materials without a name, left out";

/// The attribute says numbers above 0.
bool Sizes(const TiXmlElement& shape, const char* attribute, std::size_t count) {
  const auto sizes = NumbersOf(&shape, attribute, count);
  return sizes && std::all_of(sizes->begin(), sizes->end(), [](double size) { return size > 0.0; });
}

/// The attribute is left out, or says three numbers.
bool NoneOrThree(const TiXmlElement& element, const char* attribute) {
  return element.Attribute(attribute) == nullptr || NumbersOf(&element, attribute, 3);
}

class Repair {
 public:
  WarningLines Run(TiXmlElement& root) {
    DropAttributes(root);
    std::set<std::string> materials;
    Names children;
    for (auto* e = root.FirstChildElement("joint"); e != nullptr;
         e = e->NextSiblingElement("joint")) {
      const auto* const child = e->FirstChildElement("child");
      if (child != nullptr && child->Attribute("link") != nullptr) {
        children.emplace_back(child->Attribute("link"));
      }
    }
    for (auto* e = root.FirstChildElement(); e != nullptr;) {
      auto* const next = e->NextSiblingElement();
      if (e->ValueStr() == "link") ReadLink(*e);
      if (e->ValueStr() == "joint") {
        HoldRoot(*e, children);
        ReadJoint(*e);
      }
      if (e->ValueStr() == "material") {
        if (!HasName(*e)) {
          Drop(root, *e, kNoName, "of the robot");
        } else if (!HasColour(*e)) {
          Drop(root, *e, kNoColour, NameOf(*e));
        } else if (!materials.insert(NameOf(*e)).second) {
          Drop(root, *e, "materials that are there already, left out", NameOf(*e));
        }
      }
      e = next;
    }
    return {Sums(), Lines()};
  }

 private:
  void Note(const char* what, const TiXmlElement& element, const std::string& which) {
    places_[what].push_back(fmt::format("{} (line {})", which, element.Row()));
  }
  void Drop(TiXmlNode& parent, TiXmlElement& element, const char* what, const std::string& which) {
    Note(what, element, which);
    parent.RemoveChild(&element);
  }

  void DropAttributes(TiXmlElement& element) {
    const auto known = KnownAttributes().find(element.ValueStr());
    Names unknown;
    for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string name = a->Name();
      if (name.find(':') != std::string::npos) {
        if (!name.starts_with("xmlns")) unknown.push_back(name);
      } else if (known != KnownAttributes().end() &&
                 std::count(known->second.begin(), known->second.end(), name) == 0 &&
                 models::MisspeltName(name, known->second).empty()) {
        unknown.push_back(name);
      }
    }
    for (const std::string& name : unknown) {
      Note("attributes that URDF does not have, left out", element,
           fmt::format("'{}' of <{}>", name, element.ValueStr()));
      element.RemoveAttribute(name);
    }
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      DropAttributes(*e);
    }
  }

  void ReadLink(TiXmlElement& link) {
    const std::string name = NameOf(link);
    for (auto* e = link.FirstChildElement(); e != nullptr;) {
      auto* const next = e->NextSiblingElement();
      if (e->ValueStr() == "visual" && !HasSize(*e)) {
        Drop(link, *e, "visuals of no size, not drawn", "of link " + name);
      } else if (e->ValueStr() == "visual" && !SaysShape(*e)) {
        Drop(link, *e, "visuals that say no place or no shape, not drawn", "of link " + name);
      } else if (e->ValueStr() == "visual" || e->ValueStr() == "collision") {
        DropMaterials(*e, name);
      } else if (e->ValueStr() == "inertial" && !SaysInertia(*e)) {
        Drop(link, *e, "inertias that are incomplete, no numbers or of negative mass, left out",
             "of link " + name);
      }
      e = next;
    }
  }

  /// The first one with a colour that is one counts.
  void DropMaterials(TiXmlElement& element, const std::string& link) {
    bool found = false;
    for (auto* e = element.FirstChildElement("material"); e != nullptr;) {
      auto* const next = e->NextSiblingElement("material");
      if (!HasName(*e)) {
        Drop(element, *e, kNoName, "of link " + link);
      } else if (!HasColour(*e)) {
        Drop(element, *e, kNoColour, "of link " + link);
      } else if (std::exchange(found, true)) {
        Drop(element, *e, "materials beside another one, left out", "of link " + link);
      }
      e = next;
    }
  }

  static bool HasName(const TiXmlElement& material) {
    const char* const name = material.Attribute("name");
    return name != nullptr && *name != '\0';
  }

  /// False if it says a colour that is none.
  static bool HasColour(const TiXmlElement& material) {
    const auto* const colour = material.FirstChildElement("color");
    if (colour == nullptr) return true;
    const auto rgba = NumbersOf(colour, "rgba", 4);
    return rgba && std::all_of(rgba->begin(), rgba->end(),
                               [](double part) { return part >= 0.0 && part <= 1.0; });
  }

  /// A shape whose sizes are numbers that are all above 0; what is no such shape is read elsewhere.
  static bool HasSize(const TiXmlElement& visual) {
    const auto* const geometry = visual.FirstChildElement("geometry");
    const auto* const shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    if (shape == nullptr) return true;
    const std::string& kind = shape->ValueStr();
    const auto above = [&](const char* attribute, std::size_t count) {
      const auto sizes = NumbersOf(shape, attribute, count);
      return !sizes ||
             std::all_of(sizes->begin(), sizes->end(), [](double size) { return size != 0.0; });
    };
    if (kind == "sphere") return above("radius", 1);
    if (kind == "cylinder") return above("radius", 1) && above("length", 1);
    if (kind == "box") return above("size", 3);
    return kind != "mesh" || above("scale", 3);
  }

  /// Where it is, and one shape that URDF has, with what that needs.
  static bool SaysShape(const TiXmlElement& visual) {
    const auto* const origin = visual.FirstChildElement("origin");
    if (origin != nullptr && !(NoneOrThree(*origin, "xyz") && NoneOrThree(*origin, "rpy"))) {
      return false;
    }
    const auto* const geometry = visual.FirstChildElement("geometry");
    const auto* const shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    if (shape == nullptr || shape->NextSiblingElement() != nullptr) return false;
    const std::string& kind = shape->ValueStr();
    if (kind == "sphere") return Sizes(*shape, "radius", 1);
    if (kind == "cylinder") return Sizes(*shape, "radius", 1) && Sizes(*shape, "length", 1);
    if (kind == "box") return Sizes(*shape, "size", 3);
    const char* const file = shape->Attribute("filename");
    return kind == "mesh" && file != nullptr && *file != '\0' && NoneOrThree(*shape, "scale");
  }

  static bool SaysInertia(const TiXmlElement& inertial) {
    const auto* const mass = inertial.FirstChildElement("mass");
    const auto* const inertia = inertial.FirstChildElement("inertia");
    if (const auto* const origin = inertial.FirstChildElement("origin")) {
      for (const char* part : {"xyz", "rpy"}) {
        if (origin->Attribute(part) != nullptr && !NumbersOf(origin, part, 3)) return false;
      }
    }
    const auto kilograms = NumbersOf(mass, "value", 1);
    if (!kilograms || kilograms->front() < 0.0) return false;
    for (const char* entry : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) {
      if (!NumbersOf(inertia, entry, 1)) return false;
    }
    return true;
  }

  void HoldRoot(TiXmlElement& joint, const Names& children) {
    const char* const type = joint.Attribute("type");
    if (type == nullptr || (std::string(type) != "floating" && std::string(type) != "planar"))
      return;
    const auto* const parent = joint.FirstChildElement("parent");
    const char* const link = parent == nullptr ? nullptr : parent->Attribute("link");
    if (link == nullptr || std::count(children.begin(), children.end(), link) > 0) return;
    Note("joints of the root, held where base_pose puts it", joint,
         fmt::format("{} {}", type, NameOf(joint)));
    joint.SetAttribute("type", "fixed");
  }

  void ReadJoint(TiXmlElement& joint) {
    const char* const type = joint.Attribute("type");
    const bool fixed = type != nullptr && std::string(type) == "fixed";
    for (auto* e = joint.FirstChildElement(); e != nullptr;) {
      auto* const next = e->NextSiblingElement();
      const std::string& kind = e->ValueStr();
      if (kind == "dynamics" || kind == "calibration") {
        if (!SaysNumbers(*e)) {
          Drop(joint, *e, "dynamics and calibrations that are no numbers, left out",
               fmt::format("<{}> of joint {}", kind, NameOf(joint)));
        } else if (e != joint.FirstChildElement(kind)) {
          Drop(joint, *e, "elements that are there already, left out",
               fmt::format("<{}> of joint {}", kind, NameOf(joint)));
        }
      } else if (kind == "safety_controller") {
        FillGains(*e, joint);
      } else if (fixed && (kind == "limit" || kind == "axis")) {
        joint.RemoveChild(e);  // they mean nothing there
      }
      e = next;
    }
    FillLimit(joint);
  }

  /// At least one, which urdfdom wants, and nothing that is none.
  static bool SaysNumbers(const TiXmlElement& element) {
    if (element.FirstAttribute() == nullptr) return false;
    for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (!NumbersOf(&element, a->Name(), 1)) return false;
    }
    return true;
  }

  /// urdfdom wants the gains, which nothing here reads; soft limits are told (UrdfReader).
  void FillGains(TiXmlElement& controller, const TiXmlElement& joint) {
    for (const char* const what :
         {"k_velocity", "k_position", "soft_lower_limit", "soft_upper_limit"}) {
      if (NumbersOf(&controller, what, 1)) continue;
      if (controller.Attribute(what) == nullptr && std::string(what) != "k_velocity") continue;
      Note("numbers of safety_controllers that are none, left out", controller,
           fmt::format("{} of joint {}", what, NameOf(joint)));
      controller.RemoveAttribute(what);
      if (std::string(what) == "k_velocity") controller.SetAttribute(what, "0");
    }
  }

  /// No effort, and no velocity, which urdfdom wants, is one of 0: not given (LimitWarnings). An
  /// end of the range that is left out is 0, if the other is there.
  void FillLimit(TiXmlElement& joint) {
    auto* const limit = joint.FirstChildElement("limit");
    if (limit == nullptr) return;
    const char* const type = joint.Attribute("type");
    const bool bounded = type != nullptr && std::string(type) != "continuous";
    for (const auto& [end, other, sign] :
         {std::tuple("lower", "upper", 1.0), std::tuple("upper", "lower", -1.0)}) {
      const auto there = NumbersOf(limit, other, 1);
      // A range that ends before it begins is no range: what is missing is told.
      if (!bounded || limit->Attribute(end) != nullptr || !there || sign * there->front() < 0.0) {
        continue;
      }
      Note("limits that say one end of the range, 0 at the other", *limit,
           fmt::format("no {} of joint {}", end, NameOf(joint)));
      limit->SetAttribute(end, "0");
    }
    if (limit->Attribute("velocity") == nullptr) limit->SetAttribute("velocity", "0");
    const auto effort = NumbersOf(limit, "effort", 1);
    if (effort && effort->front() >= 0.0) return;
    if (const char* const text = limit->Attribute("effort")) {
      Note("efforts that are no number or below 0, left out", *limit,
           fmt::format("'{}' of joint {}", text, NameOf(joint)));
    }
    limit->SetAttribute("effort", "0");
  }

  static std::string NameOf(const TiXmlElement& element) {
    const char* const name = element.Attribute("name");
    return fmt::format("'{}'", name == nullptr ? "" : name);
  }

  Names Lines() const {
    Names lines;
    for (const auto& [what, places] : places_) {
      for (const std::string& place : places) lines.push_back(fmt::format("{}: {}", what, place));
    }
    return lines;
  }

  Names Sums() const {
    constexpr std::size_t kShown = 3;
    Names lines;
    for (const auto& [what, places] : places_) {
      const std::size_t shown = std::min(kShown, places.size());
      std::string line = fmt::format(
          "{}: {}", what,
          fmt::join(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
      if (shown < places.size()) line += fmt::format(" and {} more", places.size() - shown);
      lines.push_back(std::move(line));
    }
    return lines;
  }

  std::map<std::string, Names> places_;  // by what was done
};

}  // namespace

WarningLines RepairUrdf(TiXmlElement& root) { return Repair().Run(root); }

}  // namespace oca::robot
