// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_shape.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <cmath>

#include "oca/models/geometry/rotation.h"

namespace oca::robot {
namespace {

constexpr double kFarthest = 1e6;  // m; from there on a double no longer tells 1e-10 apart

std::string CheckMesh(const XmlReader& xml, const TiXmlElement& mesh) {
  xml.CheckAttributes(mesh, {"filename", "scale"});
  std::string file = xml.Text(mesh, "filename");
  const auto scale = xml.Numbers(mesh, "scale", 3);
  if (std::find(scale.begin(), scale.end(), 0.0) != scale.end()) {
    xml.Fail(mesh, "scale", fmt::format("'{}'", mesh.Attribute("scale")), "no zero");
  }
  return file;
}

}  // namespace

void CheckUrdfOrigin(const XmlReader& xml, const TiXmlElement& parent) {
  const auto* const origin = parent.FirstChildElement("origin");
  if (origin == nullptr) return;
  xml.CheckAttributes(*origin, {"xyz", "rpy", "quat_xyzw"});
  const auto xyz = xml.Numbers(*origin, "xyz", 3);
  xml.Numbers(*origin, "rpy", 3);
  if (origin->Attribute("quat_xyzw") != nullptr) UrdfQuaternion(xml, *origin);
  if (parent.ValueStr() == "visual") return;  // only drawn
  for (const double part : xyz) {
    if (std::fabs(part) <= kFarthest) continue;
    xml.Fail(*origin, "xyz", fmt::format("'{}'", origin->Attribute("xyz")),
             fmt::format("at most {:g} m", kFarthest));
  }
}

Eigen::Quaterniond UrdfQuaternion(const XmlReader& xml, const TiXmlElement& origin) {
  if (origin.Attribute("rpy") != nullptr) {
    xml.Fail(origin, "quat_xyzw", "rpy beside it", "one of the two");
  }
  const auto numbers = xml.Numbers(origin, "quat_xyzw", 4, true);
  return geometry::FromQuaternion(Eigen::Vector4d(numbers.data()), xml.Place(origin, "quat_xyzw"));
}

void CheckUrdfCapsule(const XmlReader& xml, const TiXmlElement& capsule) {
  xml.Positive(capsule, "radius", 1);
  const double length = xml.Numbers(capsule, "length", 1, true).front();
  if (length < 0.0) xml.Fail(capsule, "length", fmt::format("{}", length), "0 or more");
}

std::string CheckUrdfGeometry(const XmlReader& xml, const TiXmlElement& solid) {
  const auto* const geometry = solid.FirstChildElement("geometry");
  if (geometry == nullptr) xml.Fail(solid, "geometry", "none", "a <geometry>");
  const auto* const shape = geometry->FirstChildElement();
  if (shape == nullptr || shape->NextSiblingElement() != nullptr) {
    xml.Fail(*geometry, "shapes", shape == nullptr ? "none" : "several", "one shape");
  }
  const std::string& kind = shape->ValueStr();
  if (kind == "sphere") {
    xml.CheckAttributes(*shape, {"radius"});
    xml.Positive(*shape, "radius", 1);
  } else if (kind == "cylinder") {
    xml.CheckAttributes(*shape, {"radius", "length"});
    xml.Positive(*shape, "radius", 1);
    xml.Positive(*shape, "length", 1);
  } else if (kind == "capsule") {
    xml.CheckAttributes(*shape, {"radius", "length"});
    CheckUrdfCapsule(xml, *shape);
  } else if (kind == "box") {
    xml.CheckAttributes(*shape, {"size"});
    xml.Positive(*shape, "size", 3);
  } else if (kind == "mesh") {
    return CheckMesh(xml, *shape);
  } else {
    xml.Fail(*shape, "unknown geometry", kind, "sphere, box, cylinder, capsule or mesh");
  }
  return {};
}

}  // namespace oca::robot
