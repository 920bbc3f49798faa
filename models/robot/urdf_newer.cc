// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_newer.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <Eigen/Geometry>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/robot/urdf_shape.h"
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
  Rewriter(const std::string& where, models::ModelErrors& errors) : errors_(errors), xml_(where) {}

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
      RewriteOrigin(*e);
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
      RewriteOrigin(*e);
      const std::string& kind = e->ValueStr();
      if (kind == "collision" || kind == "visual") RewriteCapsule(*e);
    }
  }

  /// What throws is refused where it is read (CheckUrdfOrigin, CheckUrdfGeometry).
  template <class Check>
  static bool Right(const Check& check) {
    models::ModelErrors errors;
    errors.Try(check);
    return errors.empty();
  }

  void RewriteOrigin(TiXmlElement& parent) {
    auto* const origin = parent.FirstChildElement("origin");
    if (origin == nullptr || origin->Attribute(kQuaternion) == nullptr) return;
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    if (!Right([&] { q = UrdfQuaternion(xml_, *origin); })) return;
    const Eigen::Vector3d rpy = ToRollPitchYaw(q.toRotationMatrix());
    origin->SetAttribute("rpy", fmt::format("{} {} {}", rpy.x(), rpy.y(), rpy.z()));
    origin->RemoveAttribute(kQuaternion);
    newer_.changed = true;
  }

  void RewriteCapsule(TiXmlElement& solid) {
    auto* const geometry = solid.FirstChildElement("geometry");
    auto* const shape = geometry == nullptr ? nullptr : geometry->FirstChildElement("capsule");
    if (shape == nullptr || !Right([&] { CheckUrdfCapsule(xml_, *shape); })) return;
    newer_.changed = true;
    if (xml_.Numbers(*shape, "length", 1, true).front() > 0.0) {
      shape->SetValue("cylinder");
      newer_.capsules.insert(&solid);
    } else {
      shape->SetValue("sphere");
      shape->RemoveAttribute("length");
    }
  }

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
