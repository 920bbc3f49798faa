// SPDX-License-Identifier: BSD-3-Clause
#include "systems/geometry_params.h"

#include <fmt/format.h>

#include <utility>

#include "framework/error.h"
#include "models/error.h"
#include "models/geometry/mesh.h"
#include "systems/rotation.h"

namespace oca::systems {
namespace {

void CheckFinite(bool finite, const std::string& where) {
  if (!finite) throw ConfigError(where + ": got a NaN or an infinity; expected finite numbers");
}

// Which sizes each type has, in the order of ShapeType.
struct Sizes {
  bool radius, length, size, file;
};
constexpr Sizes kSizes[] = {{true, false, false, false},
                            {false, false, true, false},
                            {true, true, false, false},
                            {true, true, false, false},
                            {false, false, false, true}};

void CheckPresence(bool present, bool wanted, const char* key, ShapeType type,
                   const std::string& where) {
  if (present == wanted) return;
  throw ConfigError(fmt::format("{}.{}: got {}; expected {} of a {}", where, key,
                                present ? "a value" : "none", wanted ? "one, the size" : "none",
                                EnumNames(type)[static_cast<int>(type)]));
}

models::Shape MakeShape(const ShapeParams& shape, const std::string& where) {
  const Sizes& has = kSizes[static_cast<int>(shape.type)];
  CheckPresence(shape.radius.has_value(), has.radius, "radius", shape.type, where);
  CheckPresence(shape.length.has_value(), has.length, "length", shape.type, where);
  CheckPresence(shape.size.has_value(), has.size, "size", shape.type, where);
  CheckPresence(shape.file.has_value(), has.file, "file", shape.type, where);
  switch (shape.type) {
    case ShapeType::kSphere:
      return models::Sphere{*shape.radius};
    case ShapeType::kBox:
      return models::Box{*shape.size};
    case ShapeType::kCylinder:
      return models::Cylinder{*shape.radius, *shape.length};
    case ShapeType::kCapsule:
      return models::Capsule{*shape.radius, *shape.length};
    case ShapeType::kMesh:
      break;
  }
  return models::ConvexMesh{models::LoadConvexHull(*shape.file)};
}

}  // namespace

void PoseParams::Describe(Fields<PoseParams>& fields) {
  fields.Add("xyz", &PoseParams::xyz, "m", "position");
  fields.Add("rpy", &PoseParams::rpy, "rad", "roll, pitch, yaw about the fixed axes x, y, z");
  fields.Add("quaternion", &PoseParams::quaternion, "", "rotation [x, y, z, w], instead of rpy");
}

Eigen::Isometry3d PoseParams::Pose(const std::string& where) const {
  if (rpy && quaternion) {
    throw ConfigError(where + ": got rpy and quaternion; expected one of the two");
  }
  CheckFinite(xyz.allFinite() && (!rpy || rpy->allFinite()), where);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = xyz;
  if (rpy) pose.linear() = FromRollPitchYaw(*rpy).toRotationMatrix();
  if (quaternion) {
    if (quaternion->size() != 4) {
      throw ConfigError(fmt::format("{}.quaternion: got {} numbers; expected 4: [x, y, z, w]",
                                    where, quaternion->size()));
    }
    pose.linear() = FromQuaternion(*quaternion, where + ".quaternion").toRotationMatrix();
  }
  return pose;
}

void ShapeParams::Describe(Fields<ShapeParams>& fields) {
  fields.Add("type", &ShapeParams::type, "", "sphere, box, cylinder, capsule or mesh").Required();
  fields.Add("radius", &ShapeParams::radius, "m", "of a sphere, cylinder or capsule").Above(0.0);
  fields
      .Add("length", &ShapeParams::length, "m",
           "of the straight part of a cylinder or capsule, along z")
      .Above(0.0);
  fields.Add("size", &ShapeParams::size, "m", "full edge lengths of a box").Above(0.0);
  fields.Add("file", &ShapeParams::file, "", "mesh (STL, OBJ, Collada); its convex hull counts");
}

std::shared_ptr<const ObstacleBody> MakeObstacleBody(const std::string& id,
                                                     const ShapeParams& shape,
                                                     const std::string& where) {
  try {
    return std::make_shared<const ObstacleBody>(
        ObstacleBody{models::Name(id), models::MakeCollider(MakeShape(shape, where), where),
                     shape.file.value_or("")});
  } catch (const models::ModelError& error) {
    const std::string what = error.what();
    throw ConfigError(what.starts_with(where) ? what : where + ": " + what);
  }
}

ShapeParams ShapeParamsOf(const ObstacleBody& body) {
  const models::Shape& shape = body.collider->shape();
  ShapeParams params{.type = ShapeType::kMesh, .radius = {}, .length = {}, .size = {}, .file = {}};
  if (const auto* sphere = std::get_if<models::Sphere>(&shape)) {
    params.type = ShapeType::kSphere;
    params.radius = sphere->radius;
  } else if (const auto* box = std::get_if<models::Box>(&shape)) {
    params.type = ShapeType::kBox;
    params.size = box->size;
  } else if (const auto* cylinder = std::get_if<models::Cylinder>(&shape)) {
    params.type = ShapeType::kCylinder;
    params.radius = cylinder->radius;
    params.length = cylinder->length;
  } else if (const auto* capsule = std::get_if<models::Capsule>(&shape)) {
    params.type = ShapeType::kCapsule;
    params.radius = capsule->radius;
    params.length = capsule->length;
  } else {
    params.file = body.file;
  }
  return params;
}

}  // namespace oca::systems
