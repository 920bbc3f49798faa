// SPDX-License-Identifier: BSD-3-Clause
#include "models/robot/urdf_outline.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "models/error.h"
#include "models/robot/nearest_name.h"
#include "models/robot/xml_numbers.h"

namespace oca::models {
namespace {

using Names = std::vector<std::string>;

const char* AttributeOr(const TiXmlElement& element, const char* name, const char* fallback) {
  const char* text = element.Attribute(name);
  return text == nullptr ? fallback : text;
}

class OutlineReader {
 public:
  explicit OutlineReader(const std::string& where) : where_(where) {}

  UrdfOutline Read(const TiXmlElement& root) {
    if (root.ValueStr() != "robot") {
      Fail(root, "root element", root.ValueStr(), "robot");
    }
    CheckExpanded(root);
    UrdfOutline outline;
    outline.robot_name = RequiredName(root, "robot");
    for (auto* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckKnown(*e, {"link", "joint", "material", "transmission", "gazebo", "sensor"}, "robot");
      if (e->ValueStr() == "link") outline.links.push_back(ReadLink(*e));
      if (e->ValueStr() == "joint") outline.joints.push_back(ReadJoint(*e));
    }
    if (outline.links.empty()) Fail(root, "links", "none", "at least one <link>");
    return outline;
  }

 private:
  [[noreturn]] void Fail(const TiXmlElement& element, std::string_view what, std::string_view got,
                         std::string_view expected) const {
    const std::string in = element_.empty() ? "" : element_ + " ";
    throw ModelError(fmt::format("{}:{}: {}<{}>: {}; got {}; expected {}", where_, element.Row(),
                                 in, element.ValueStr(), what, got, expected));
  }

  void CheckExpanded(const TiXmlElement& element) const {
    const std::string xacro = "expanded URDF (run xacro first)";
    if (element.ValueStr().starts_with("xacro:")) {
      Fail(element, "element", element.ValueStr(), xacro);
    }
    for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (a->ValueStr().find("${") != std::string::npos ||
          a->ValueStr().find("$(") != std::string::npos) {
        Fail(element, a->Name(), a->ValueStr(), xacro);
      }
    }
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckExpanded(*e);
    }
  }

  // Elements of other tools pass; a misspelt one of ours does not.
  void CheckKnown(const TiXmlElement& element, const Names& known, const char* parent) const {
    const std::string& name = element.ValueStr();
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const std::string nearest = NearestName(name, known);
    if (EditDistance(name, nearest) <= 2) {
      Fail(element, fmt::format("unknown element in <{}>", parent), name, nearest);
    }
  }

  void CheckChildren(const TiXmlElement& element, const Names& once, const Names& repeated) const {
    Names known = once;
    known.insert(known.end(), repeated.begin(), repeated.end());
    std::set<std::string> seen;
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckKnown(*e, known, element.Value());
      const bool single = std::find(once.begin(), once.end(), e->ValueStr()) != once.end();
      if (single && !seen.insert(e->ValueStr()).second) {
        Fail(*e, fmt::format("element in <{}>", element.ValueStr()), "a second one", "one");
      }
    }
  }

  std::string RequiredName(const TiXmlElement& element, const char* kind) const {
    const std::string name = AttributeOr(element, "name", "");
    if (name.empty()) Fail(element, "name", "none", fmt::format("a name of the {}", kind));
    return name;
  }

  // `count` finite numbers; absent attributes pass unless `required`.
  std::vector<double> Numbers(const TiXmlElement& element, const char* attribute, int count,
                              bool required = false) const {
    const char* text = element.Attribute(attribute);
    if (text == nullptr) {
      if (required) Fail(element, attribute, "nothing", fmt::format("{} number(s)", count));
      return {};
    }
    const auto numbers = ParseFiniteNumbers(text);
    if (!numbers || static_cast<int>(numbers->size()) != count) {
      Fail(element, attribute, fmt::format("'{}'", text),
           fmt::format("{} finite number(s)", count));
    }
    return *numbers;
  }

  void Positive(const TiXmlElement& element, const char* attribute, int count) const {
    for (const double number : Numbers(element, attribute, count, true)) {
      if (!(number > 0.0)) {
        Fail(element, attribute, element.Attribute(attribute), "more than 0");
      }
    }
  }

  void CheckOrigin(const TiXmlElement& parent) const {
    const auto* origin = parent.FirstChildElement("origin");
    if (origin == nullptr) return;
    CheckAttributes(*origin, {"xyz", "rpy"});
    Numbers(*origin, "xyz", 3);
    Numbers(*origin, "rpy", 3);
  }

  void CheckAttributes(const TiXmlElement& element, const Names& known) const {
    for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (std::find(known.begin(), known.end(), a->Name()) == known.end()) {
        Fail(element, "unknown attribute", fmt::format("'{}'", a->Name()),
             fmt::format("one of {}", fmt::join(known, ", ")));
      }
    }
  }

  void CheckGeometry(const TiXmlElement& element) const {
    const auto* geometry = element.FirstChildElement("geometry");
    if (geometry == nullptr) Fail(element, "geometry", "none", "a <geometry>");
    const auto* shape = geometry->FirstChildElement();
    if (shape == nullptr || shape->NextSiblingElement() != nullptr) {
      Fail(*geometry, "shapes", shape == nullptr ? "none" : "several", "one shape");
    }
    const std::string& kind = shape->ValueStr();
    if (kind == "sphere") {
      CheckAttributes(*shape, {"radius"});
      Positive(*shape, "radius", 1);
    } else if (kind == "cylinder") {
      CheckAttributes(*shape, {"radius", "length"});
      Positive(*shape, "radius", 1);
      Positive(*shape, "length", 1);
    } else if (kind == "box") {
      CheckAttributes(*shape, {"size"});
      Positive(*shape, "size", 3);
    } else if (kind == "mesh") {
      CheckMesh(*shape);
    } else {
      Fail(*shape, "unknown geometry", kind,
           "sphere, box, cylinder or mesh (a capsule is a cylinder and two spheres)");
    }
  }

  void CheckMesh(const TiXmlElement& mesh) const {
    CheckAttributes(mesh, {"filename", "scale"});
    if (std::string_view(AttributeOr(mesh, "filename", "")).empty()) {
      Fail(mesh, "filename", "nothing", "a path");
    }
    for (const double factor : Numbers(mesh, "scale", 3)) {
      if (factor == 0.0) Fail(mesh, "scale", mesh.Attribute("scale"), "no zero");
    }
  }

  void CheckMaterial(const TiXmlElement& parent) const {
    const auto* material = parent.FirstChildElement("material");
    const auto* colour = material == nullptr ? nullptr : material->FirstChildElement("color");
    if (colour != nullptr) Numbers(*colour, "rgba", 4, true);
  }

  void CheckInertial(const TiXmlElement& link) const {
    const auto* inertial = link.FirstChildElement("inertial");
    if (inertial == nullptr) return;
    CheckChildren(*inertial, {"origin", "mass", "inertia"}, {});
    CheckOrigin(*inertial);
    const auto* mass = inertial->FirstChildElement("mass");
    const auto* inertia = inertial->FirstChildElement("inertia");
    if (mass == nullptr || inertia == nullptr) {
      Fail(*inertial, "content", "no <mass> or no <inertia>", "both");
    }
    if (Numbers(*mass, "value", 1, true)[0] < 0.0) {
      Fail(*mass, "value", mass->Attribute("value"), "0 or more");
    }
    for (const char* entry : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) {
      Numbers(*inertia, entry, 1, true);
    }
  }

  UrdfOutline::Link ReadLink(const TiXmlElement& element) {
    UrdfOutline::Link link{RequiredName(element, "link"), element.Row(), {}, {}};
    element_ = fmt::format("link '{}'", link.name);
    if (!link_names_.insert(link.name).second) {
      Fail(element, "name", "one that is taken", "a name of its own");
    }
    CheckChildren(element, {"inertial"}, {"visual", "collision", "contact", "sensor"});
    CheckInertial(element);
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const bool collision = e->ValueStr() == "collision";
      if (!collision && e->ValueStr() != "visual") continue;
      CheckChildren(*e, {"origin", "geometry"}, {"material", "contact_coefficients", "verbose"});
      CheckOrigin(*e);
      CheckGeometry(*e);
      CheckMaterial(*e);
      (collision ? link.collision_lines : link.visual_lines).push_back(e->Row());
    }
    element_.clear();
    return link;
  }

  void CheckLimit(const TiXmlElement& element, const std::string& type, UrdfOutline::Joint& joint) {
    const auto* limit = element.FirstChildElement("limit");
    const bool bounded = type == "revolute" || type == "prismatic";
    if (limit == nullptr) {
      if (bounded) Fail(element, "limit", "none", "a <limit> with lower, upper, effort, velocity");
      return;
    }
    CheckAttributes(*limit, {"lower", "upper", "effort", "velocity", "acceleration", "jerk"});
    const auto lower = Numbers(*limit, "lower", 1, bounded);
    const auto upper = Numbers(*limit, "upper", 1, bounded);
    if (bounded && lower[0] > upper[0]) {
      Fail(*limit, "range", fmt::format("lower {} and upper {}", lower[0], upper[0]),
           "lower <= upper");
    }
    for (const char* attribute : {"effort", "velocity"}) {
      const auto number = Numbers(*limit, attribute, 1, type != "fixed");
      if (!number.empty() && number[0] < 0.0) {
        Fail(*limit, attribute, limit->Attribute(attribute), "0 or more");
      }
    }
    for (const char* attribute : {"acceleration", "jerk"}) {
      if (limit->Attribute(attribute) == nullptr) continue;
      Positive(*limit, attribute, 1);
      (attribute[0] == 'a' ? joint.acceleration : joint.jerk) =
          Numbers(*limit, attribute, 1).front();
    }
  }

  void CheckAxis(const TiXmlElement& element, const std::string& type) const {
    const auto* axis = element.FirstChildElement("axis");
    if (axis == nullptr) return;
    CheckAttributes(*axis, {"xyz"});
    const auto xyz = Numbers(*axis, "xyz", 3, true);
    // Exporters write a zero axis into fixed joints, where it means nothing.
    const double length = std::max({std::abs(xyz[0]), std::abs(xyz[1]), std::abs(xyz[2])});
    if (type != "fixed" && length < 1e-6) {
      Fail(*axis, "xyz", axis->Attribute("xyz"), "a direction");
    }
  }

  std::string ReadReference(const TiXmlElement& joint, const char* kind, const char* attribute) {
    const auto* reference = joint.FirstChildElement(kind);
    if (reference == nullptr) Fail(joint, kind, "none", fmt::format("a <{}>", kind));
    const std::string name = AttributeOr(*reference, attribute, "");
    if (name.empty()) Fail(*reference, attribute, "nothing", "a name");
    return name;
  }

  UrdfOutline::Joint ReadJoint(const TiXmlElement& element) {
    UrdfOutline::Joint joint;
    joint.name = RequiredName(element, "joint");
    joint.line = element.Row();
    element_ = fmt::format("joint '{}'", joint.name);
    if (!joint_names_.insert(joint.name).second) {
      Fail(element, "name", "one that is taken", "a name of its own");
    }
    CheckChildren(element,
                  {"origin", "parent", "child", "axis", "limit", "mimic", "dynamics",
                   "safety_controller", "calibration"},
                  {});
    const std::string type = AttributeOr(element, "type", "");
    const Names known{"fixed", "revolute", "continuous", "prismatic"};
    if (std::find(known.begin(), known.end(), type) == known.end()) {
      Fail(element, "unsupported joint type", fmt::format("'{}'", type),
           "fixed, revolute, continuous or prismatic");
    }
    joint.parent = ReadReference(element, "parent", "link");
    joint.child = ReadReference(element, "child", "link");
    CheckOrigin(element);
    CheckAxis(element, type);
    CheckLimit(element, type, joint);
    if (const auto* mimic = element.FirstChildElement("mimic"); mimic != nullptr) {
      CheckAttributes(*mimic, {"joint", "multiplier", "offset"});
      joint.mimic = ReadReference(element, "mimic", "joint");
      Numbers(*mimic, "multiplier", 1);
      Numbers(*mimic, "offset", 1);
    }
    element_.clear();
    return joint;
  }

  const std::string& where_;
  std::string element_;  // the link or joint being read
  std::set<std::string> link_names_, joint_names_;
};

}  // namespace

UrdfOutline ReadUrdfOutline(const TiXmlElement& root, const std::string& where) {
  return OutlineReader(where).Read(root);
}

}  // namespace oca::models
