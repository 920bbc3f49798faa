// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_newer.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <Eigen/Geometry>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/geometry/rotation.h"
#include "oca/models/robot/xml_reader.h"

namespace oca::robot {
namespace {

constexpr const char* kQuaternion = "quat_xyzw";

/// Roll, pitch and yaw that give R to the last digits, near a pitch of a quarter turn too: there
/// roll and yaw are badly known each, so roll is what is left of R after yaw.
Eigen::Vector3d ToRollPitchYaw(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double s = std::sin(yaw), c = std::cos(yaw);
  return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)), pitch, yaw};
}

class Rewriter {
 public:
  Rewriter(const std::string& where, models::ModelErrors& errors)
      : where_(where), errors_(errors), xml_(where) {}

  NewerUrdf Run(TiXmlElement& root) {
    const char* const version = root.Attribute("version");
    if (version != nullptr && std::string(version) == "1.1") {
      root.SetAttribute("version", "1.0");
      newer_.changed = true;
    } else if (version != nullptr && std::string(version) != "1.0") {
      errors_.Try([&] { xml_.Fail(root, "version", version, "1.0 or 1.1"); });
    }
    for (auto* e = root.FirstChildElement("joint"); e != nullptr;
         e = e->NextSiblingElement("joint")) {
      errors_.Try([&] { RewriteOrigin(*e); });
    }
    for (auto* e = root.FirstChildElement("link"); e != nullptr;
         e = e->NextSiblingElement("link")) {
      RewriteLink(*e);
    }
    return std::move(newer_);
  }

 private:
  void RewriteLink(TiXmlElement& link) {
    for (auto* e = link.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      errors_.Try([&] { RewriteOrigin(*e); });
      const std::string& kind = e->ValueStr();
      if (kind != "collision" && kind != "visual") continue;
      errors_.Try([&] {
        if (RewriteCapsule(*e)) newer_.capsules.insert(e);
      });
    }
  }

  void RewriteOrigin(TiXmlElement& parent) {
    auto* const origin = parent.FirstChildElement("origin");
    if (origin == nullptr || origin->Attribute(kQuaternion) == nullptr) return;
    if (origin->Attribute("rpy") != nullptr) {
      xml_.Fail(*origin, kQuaternion, "rpy beside it", "one of the two");
    }
    const auto numbers = xml_.Numbers(*origin, kQuaternion, 4);
    const std::string where =
        fmt::format("{}:{}: <origin>: {}", where_, origin->Row(), kQuaternion);
    const Eigen::Quaterniond q = geometry::FromQuaternion(Eigen::Vector4d(numbers.data()), where);
    const Eigen::Vector3d rpy = ToRollPitchYaw(q.normalized().toRotationMatrix());
    origin->SetAttribute("rpy", fmt::format("{} {} {}", rpy.x(), rpy.y(), rpy.z()));
    origin->RemoveAttribute(kQuaternion);
    newer_.changed = true;
  }

  bool RewriteCapsule(TiXmlElement& solid) {
    auto* const geometry = solid.FirstChildElement("geometry");
    auto* const shape = geometry == nullptr ? nullptr : geometry->FirstChildElement("capsule");
    if (shape == nullptr) return false;
    xml_.Positive(*shape, "radius", 1);
    const double length = xml_.Numbers(*shape, "length", 1, true).front();
    if (length < 0.0) xml_.Fail(*shape, "length", fmt::format("{}", length), "0 or more");
    newer_.changed = true;
    const bool none = length == 0.0;
    shape->SetValue(none ? "sphere" : "cylinder");
    if (none) shape->RemoveAttribute("length");
    return !none;
  }

  const std::string& where_;
  models::ModelErrors& errors_;
  const XmlReader xml_;
  NewerUrdf newer_;
};

}  // namespace

bool NewerUrdf::IsCapsule(const TiXmlElement& root, const std::string& kind,
                          const std::string& link, std::size_t place) const {
  if (capsules.empty()) return false;
  for (auto* e = root.FirstChildElement("link"); e != nullptr; e = e->NextSiblingElement("link")) {
    const char* const name = e->Attribute("name");
    if (name == nullptr || link != name) continue;
    auto* solid = e->FirstChildElement(kind);
    for (; solid != nullptr && place > 0; --place) solid = solid->NextSiblingElement(kind);
    return capsules.contains(solid);
  }
  return false;
}

NewerUrdf RewriteNewerUrdf(TiXmlElement& root, const std::string& where,
                           models::ModelErrors& errors) {
  return Rewriter(where, errors).Run(root);
}

}  // namespace oca::robot
