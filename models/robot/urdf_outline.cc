// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_outline.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <cmath>
#include <set>
#include <string_view>

#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/urdf_shape.h"
#include "oca/models/robot/xml_reader.h"

namespace oca::robot {
namespace {

class OutlineReader {
 public:
  OutlineReader(const std::string& where, models::ModelErrors& errors)
      : xml_(where), errors_(errors) {}

  UrdfOutline Read(const TiXmlElement& root) {
    if (root.ValueStr() != "robot") xml_.Fail(root, "root element", root.ValueStr(), "robot");
    xml_.CheckExpanded(root);
    xml_.CheckNames(root);
    Try([&] {
      xml_.CheckChildren(root, {},
                         {"link", "joint", "material", "transmission", "gazebo", "sensor"});
    });
    UrdfOutline outline;
    Try([&] { outline.robot_name = xml_.Text(root, "name"); });
    for (auto* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (e->ValueStr() == "link") outline.links.push_back(ReadLink(*e));
      if (e->ValueStr() == "joint") outline.joints.push_back(ReadJoint(*e));
    }
    Try([&] {
      if (outline.links.empty()) xml_.Fail(root, "links", "none", "at least one <link>");
    });
    return outline;
  }

 private:
  template <class Part>
  void Try(const Part& part) const {
    errors_.Try(part);
  }

  std::string ReadName(const TiXmlElement& element, std::set<std::string>& taken) const {
    std::string name = xml_.Text(element, "name");
    if (!taken.insert(name).second) {
      xml_.Fail(element, "name", "one that is taken", "a name of its own");
    }
    return name;
  }

  UrdfOutline::Link ReadLink(const TiXmlElement& element) {
    UrdfOutline::Link link;
    link.line = element.Row();
    Try([&] { link.name = ReadName(element, link_names_); });
    Try([&] {
      xml_.CheckChildren(element, {"inertial"}, {"visual", "collision", "contact", "sensor"});
    });
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const bool collision = e->ValueStr() == "collision";
      if (!collision && e->ValueStr() != "visual") continue;
      Try([&] {
        xml_.CheckChildren(*e, {"origin", "geometry", "material"},
                           {"contact_coefficients", "verbose"});
      });
      Try([&] { CheckUrdfOrigin(xml_, *e); });
      UrdfOutline::Element body{e->Row()};
      Try([&] { body.mesh = CheckUrdfGeometry(xml_, *e); });
      (collision ? link.collisions : link.visuals).push_back(std::move(body));
    }
    return link;
  }

  std::optional<double> ReadRate(const TiXmlElement& limit, const char* what, double least) const {
    if (limit.Attribute(what) == nullptr) return std::nullopt;
    const double rate = xml_.Positive(limit, what, 1).front();
    if (rate >= least) return rate;
    xml_.Fail(limit, what, fmt::format("{}", rate), fmt::format("{:g} or more", least));
  }

  /// 0 counts as not given.
  void CheckVelocity(const TiXmlElement& limit) const {
    const auto number = xml_.Numbers(limit, "velocity", 1, false);
    if (number.empty() || number[0] == 0.0 || number[0] >= kLeastVelocity) return;
    xml_.Fail(limit, "velocity", fmt::format("{}", number[0]),
              fmt::format("0 or more, and at least {:g} rad/s or m/s if not 0", kLeastVelocity));
  }

  UrdfOutline::Joint ReadJoint(const TiXmlElement& element) {
    UrdfOutline::Joint joint;
    joint.line = element.Row();
    Try([&] { joint.name = ReadName(element, joint_names_); });
    Try([&] {
      xml_.CheckChildren(element,
                         {"origin", "parent", "child", "axis", "limit", "mimic", "dynamics",
                          "safety_controller", "calibration"},
                         {});
    });
    Try([&] { joint.parent = ReadReference(element, "parent", "link"); });
    Try([&] { joint.child = ReadReference(element, "child", "link"); });
    Try([&] { CheckUrdfOrigin(xml_, element); });
    Try([&] { ReadMotion(element, joint); });
    if (const auto* mimic = element.FirstChildElement("mimic"); mimic != nullptr) {
      Try([&] { joint.mimic = ReadMimic(*mimic); });
    }
    return joint;
  }

  /// What depends on the joint's type.
  void ReadMotion(const TiXmlElement& element, UrdfOutline::Joint& joint) const {
    const char* text = element.Attribute("type");
    const std::string type = text == nullptr ? "" : text;
    if (type != "fixed" && type != "revolute" && type != "continuous" && type != "prismatic") {
      xml_.Fail(element, "unsupported joint type", fmt::format("'{}'", type),
                "fixed, revolute, continuous or prismatic");
    }
    joint.fixed = type == "fixed";
    Try([&] { CheckAxis(element, joint.fixed); });
    Try([&] { ReadLimit(element, type, joint); });
  }

  std::string ReadMimic(const TiXmlElement& mimic) const {
    xml_.CheckAttributes(mimic, {"joint", "multiplier", "offset"});
    xml_.Numbers(mimic, "multiplier", 1);
    xml_.Numbers(mimic, "offset", 1);
    return xml_.Text(mimic, "joint");
  }

  std::string ReadReference(const TiXmlElement& joint, const char* kind,
                            const char* attribute) const {
    const auto* reference = joint.FirstChildElement(kind);
    if (reference == nullptr) xml_.Fail(joint, kind, "none", fmt::format("a <{}>", kind));
    return xml_.Text(*reference, attribute);
  }

  void CheckAxis(const TiXmlElement& joint, bool fixed) const {
    const auto* axis = joint.FirstChildElement("axis");
    if (axis == nullptr) return;
    xml_.CheckAttributes(*axis, {"xyz"});
    const auto xyz = xml_.Numbers(*axis, "xyz", 3, true);
    // Exporters write a zero axis into fixed joints, where it means nothing.
    if (fixed) return;
    const double length = std::hypot(xyz[0], xyz[1], xyz[2]);
    if (length >= kLeastAxis && length <= kMostAxis) return;
    xml_.Fail(*axis, "xyz", fmt::format("'{}'", axis->Attribute("xyz")),
              fmt::format("a direction, of a length from {:g} to {:g}", kLeastAxis, kMostAxis));
  }

  void ReadLimit(const TiXmlElement& element, const std::string& type,
                 UrdfOutline::Joint& joint) const {
    const auto* limit = element.FirstChildElement("limit");
    const bool bounded = type == "revolute" || type == "prismatic";
    if (limit == nullptr) {
      if (!bounded) return;
      xml_.Fail(element, "limit", "none", "a <limit> with lower, upper, effort, velocity");
    }
    xml_.CheckAttributes(*limit, {"lower", "upper", "effort", "velocity", "acceleration", "jerk"});
    const auto lower = xml_.Numbers(*limit, "lower", 1, bounded);
    const auto upper = xml_.Numbers(*limit, "upper", 1, bounded);
    if (bounded && lower[0] > upper[0]) {
      xml_.Fail(*limit, "range", fmt::format("lower {} and upper {}", lower[0], upper[0]),
                "lower <= upper");
    }
    CheckVelocity(*limit);
    joint.acceleration = ReadRate(*limit, "acceleration", kLeastAcceleration);
    joint.jerk = ReadRate(*limit, "jerk", kLeastJerk);
  }

  static constexpr double kLeastAxis = 1e-6, kMostAxis = 1e6;

  XmlReader xml_;
  models::ModelErrors& errors_;
  std::set<std::string> link_names_, joint_names_;
};

}  // namespace

UrdfOutline ReadUrdfOutline(const TiXmlElement& root, const std::string& where,
                            models::ModelErrors& errors) {
  return OutlineReader(where, errors).Read(root);
}

}  // namespace oca::robot
