// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/geometry_params.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/geometry/decomposition.h"
#include "oca/models/geometry/mesh_surface.h"
#include "oca/models/geometry/octree.h"
#include "oca/models/geometry/point_cloud.h"

namespace oca::systems {
namespace {

// Which sizes each type has, in the order of ShapeType.
struct Sizes {
  bool radius{false}, length{false}, size{false}, radii{false}, file{false}, parts{false},
      grid{false};
};
constexpr std::array<Sizes, kShapeTypeNames.size()> kSizes{{{.radius = true},
                                                            {.size = true},
                                                            {.radius = true, .length = true},
                                                            {.radius = true, .length = true},
                                                            {.file = true},
                                                            {.radius = true, .length = true},
                                                            {.radii = true},
                                                            {},
                                                            {.parts = true},
                                                            {.radius = true, .file = true},
                                                            {.file = true, .grid = true},
                                                            {.file = true}}};

// "a box", "an ellipsoid".
std::string OneOf(ShapeType type) {
  const std::string name = EnumNames(type)[static_cast<int>(type)];
  return (name.find_first_of("aeiou") == 0 ? "an " : "a ") + name;
}

void CheckPresence(bool present, bool wanted, const char* key, ShapeType type,
                   const std::string& where) {
  if (present == wanted) return;
  throw ConfigError(fmt::format("{}.{}: got {}; expected {} of {}", where, key,
                                present ? "a value" : "none", wanted ? "one, the size" : "none",
                                OneOf(type)));
}

void CheckSizes(const SolidParams& shape, bool parts, const std::string& where) {
  const Sizes& has = kSizes[static_cast<int>(shape.type)];
  CheckPresence(shape.radius.has_value(), has.radius, "radius", shape.type, where);
  CheckPresence(shape.length.has_value(), has.length, "length", shape.type, where);
  CheckPresence(shape.size.has_value(), has.size, "size", shape.type, where);
  CheckPresence(shape.radii.has_value(), has.radii, "radii", shape.type, where);
  CheckPresence(shape.file.has_value(), has.file, "file", shape.type, where);
  if (shape.file && shape.file->empty()) {
    throw ConfigError(where + ".file: got an empty file name; expected a path");
  }
  CheckPresence(parts, has.parts, "parts", shape.type, where);
}

using Warnings = std::vector<std::string>*;

geometry::Shape MakeHull(const std::string& file, const std::string& where, Warnings warnings) {
  const auto [hull, excess, flatness] = geometry::LoadMeshHull(file);
  const std::string remark =
      excess.empty() ? flatness : excess + "; collision: decomposition splits it";
  if (warnings != nullptr && !remark.empty()) {
    warnings->push_back(fmt::format("{}: mesh '{}' {}", where, file, remark));
  }
  return geometry::ConvexMesh{hull};
}

geometry::Shape MakeSolid(const SolidParams& shape, const std::string& where, Warnings warnings) {
  switch (shape.type) {
    case ShapeType::kSphere:
      return geometry::Sphere{*shape.radius};
    case ShapeType::kBox:
      return geometry::Box{*shape.size};
    case ShapeType::kCylinder:
      return geometry::Cylinder{*shape.radius, *shape.length};
    case ShapeType::kCapsule:
      return geometry::Capsule{*shape.radius, *shape.length};
    case ShapeType::kMesh:
      return MakeHull(*shape.file, where, warnings);
    case ShapeType::kCone:
      return geometry::Cone{*shape.radius, *shape.length};
    case ShapeType::kEllipsoid:
      return geometry::Ellipsoid{*shape.radii};
    case ShapeType::kHalfSpace:
      return geometry::HalfSpace{};
    case ShapeType::kCompound:
    case ShapeType::kCloud:
    case ShapeType::kHeightmap:
    case ShapeType::kOctree:
      break;
  }
  return geometry::Compound{};
}

geometry::Shape MakeCompound(const ShapeParams& shape, const std::string& where,
                             Warnings warnings) {
  geometry::Compound compound;
  for (std::size_t i = 0; i < shape.parts.size(); ++i) {
    const PartParams& part = shape.parts[i];
    const std::string name = fmt::format("{}.parts[{}]", where, i);
    if (part.shape.type >= ShapeType::kHalfSpace) {
      throw ConfigError(fmt::format("{}.shape.type: got {}; expected a convex body that ends", name,
                                    OneOf(part.shape.type)));
    }
    CheckSizes(part.shape, false, name + ".shape");
    compound.parts.push_back({part.pose.value_or(PoseParams()).Pose(name + ".pose"),
                              MakeSolid(part.shape, name + ".shape", warnings)});
  }
  return compound;
}

void CheckShape(const ShapeParams& shape, const std::string& where) {
  CheckSizes(shape, !shape.parts.empty(), where);
  const bool grid = kSizes[static_cast<int>(shape.type)].grid;
  CheckPresence(shape.cell.has_value(), grid, "cell", shape.type, where);
  CheckPresence(shape.scale.has_value(), grid, "scale", shape.type, where);
  if (shape.collision && shape.type != ShapeType::kMesh) {
    throw ConfigError(
        fmt::format("{}.collision: got a value; expected none of {}, only a mesh has it", where,
                    OneOf(shape.type)));
  }
}

geometry::Shape MakeShape(const ShapeParams& shape, const std::string& where, Warnings warnings) {
  switch (shape.type) {
    case ShapeType::kCloud:
      return geometry::MakeCloud(geometry::LoadPointCloud(*shape.file), *shape.radius);
    case ShapeType::kHeightmap:
      return geometry::LoadHeightmap(*shape.file, *shape.cell, *shape.scale);
    case ShapeType::kOctree:
      return geometry::LoadOctree(*shape.file);
    case ShapeType::kCompound:
      return MakeCompound(shape, where, warnings);
    default:
      break;
  }
  if (shape.collision == CollisionMeshes::kDecomposition) {
    return geometry::LoadDecomposition(*shape.file);
  }
  return MakeSolid(shape, where, warnings);
}

using ColliderPtr = std::shared_ptr<const geometry::Collider>;

ColliderPtr MakeShapeCollider(const ShapeParams& shape, const std::string& where,
                              Warnings warnings) {
  CheckShape(shape, where);
  const auto make = [&]() -> ColliderPtr {
    return geometry::MakeCollider(MakeShape(shape, where, warnings), where);
  };
  const bool hull =
      shape.type == ShapeType::kMesh && shape.collision != CollisionMeshes::kDecomposition;
  if (!shape.file || hull) return make();
  // Many parts; what is said of them names the file alone.
  const std::string form =
      fmt::format("{} {} {} {}", static_cast<int>(shape.type), shape.radius.value_or(0.0),
                  shape.cell.value_or(0.0), shape.scale.value_or(0.0));
  return *models::MakeOnce<ColliderPtr>(*shape.file, form, make);
}

// The fields that a part and a whole have in common.
template <class P>
void DescribeSolid(const char* types, Fields<P>& fields) {
  using Number = std::optional<double>;
  using Triple = std::optional<Eigen::Vector3d>;
  using File = std::optional<std::string>;
  fields.template Add<ShapeType>("type", &P::type, "", types).Required();
  fields
      .template Add<Number>(
          "radius", &P::radius, "m",
          "of a sphere, cylinder, capsule or cone, or of the ball about each point of a cloud")
      .Above(0.0);
  fields
      .template Add<Number>("length", &P::length, "m",
                            "along z, of a cylinder, a cone or the straight part of a capsule")
      .Above(0.0);
  fields.template Add<Triple>("size", &P::size, "m", "full edge lengths of a box").Above(0.0);
  fields.template Add<Triple>("radii", &P::radii, "m", "semi-axes of an ellipsoid").Above(0.0);
  fields.template Add<File>("file", &P::file, "",
                            "mesh (STL, OBJ, Collada, PLY), cloud (CSV, XYZ, PLY, PCD), heightmap "
                            "(PGM, CSV) or octree (BT, OT)");
}

SolidParams SolidParamsOf(const geometry::Shape& shape) {
  SolidParams params;
  if (const auto* sphere = std::get_if<geometry::Sphere>(&shape)) {
    params.radius = sphere->radius;
  } else if (const auto* box = std::get_if<geometry::Box>(&shape)) {
    params.type = ShapeType::kBox;
    params.size = box->size;
  } else if (const auto* cylinder = std::get_if<geometry::Cylinder>(&shape)) {
    params.type = ShapeType::kCylinder;
    params.radius = cylinder->radius;
    params.length = cylinder->length;
  } else if (const auto* capsule = std::get_if<geometry::Capsule>(&shape)) {
    params.type = ShapeType::kCapsule;
    params.radius = capsule->radius;
    params.length = capsule->length;
  } else if (const auto* mesh = std::get_if<geometry::ConvexMesh>(&shape)) {
    params.type = ShapeType::kMesh;
    params.file = mesh->hull->name;
  } else if (const auto* cone = std::get_if<geometry::Cone>(&shape)) {
    params.type = ShapeType::kCone;
    params.radius = cone->radius;
    params.length = cone->length;
  } else if (const auto* ellipsoid = std::get_if<geometry::Ellipsoid>(&shape)) {
    params.type = ShapeType::kEllipsoid;
    params.radii = ellipsoid->radii;
  } else {
    params.type = std::holds_alternative<geometry::HalfSpace>(shape) ? ShapeType::kHalfSpace
                                                                     : ShapeType::kCompound;
  }
  return params;
}

}  // namespace

std::string_view NameOf(const geometry::Shape& shape) {
  return kShapeTypeNames[static_cast<std::size_t>(SolidParamsOf(shape).type)];
}

void SolidParams::Describe(Fields<SolidParams>& fields) {
  DescribeSolid("sphere, box, cylinder, capsule, mesh, cone or ellipsoid", fields);
}

void PartParams::Describe(Fields<PartParams>& fields) {
  fields.Add("shape", &PartParams::shape, "", "convex body").Required();
  fields.Add("pose", &PartParams::pose, "", "in the frame of the compound");
}

void ShapeParams::Describe(Fields<ShapeParams>& fields) {
  DescribeSolid(
      "sphere, box, cylinder, capsule, mesh, cone (apex up), ellipsoid, half_space (all below the "
      "xy plane), compound, cloud, heightmap or octree",
      fields);
  fields.Add("parts", &ShapeParams::parts, "", "convex bodies that make a compound");
  fields.Add("cell", &ShapeParams::cell, "m", "width of a heightmap's cell").Above(0.0);
  fields.Add("scale", &ShapeParams::scale, "m", "height of a heightmap's full grey, or of 1 in CSV")
      .Above(0.0);
  fields.Add<std::optional<CollisionMeshes>>(
      "collision", &ShapeParams::collision, "",
      "what a mesh counts as: hull (if left out), or decomposition into convex parts");
}

std::shared_ptr<const ObstacleBody> MakeObstacleBody(const std::string& id,
                                                     const ShapeParams& shape,
                                                     const std::string& where,
                                                     std::vector<std::string>* warnings) {
  try {
    return std::make_shared<const ObstacleBody>(ObstacleBody{
        models::Name(id), MakeShapeCollider(shape, where, warnings), shape.file.value_or("")});
  } catch (const models::ModelError& error) {
    const std::string what = error.what();
    throw ConfigError(what.starts_with(where) ? what : where + ": " + what);
  }
}

namespace {

// Of a compound that a file gave.
std::optional<ShapeParams> FileParamsOf(const geometry::Compound& compound,
                                        const std::string& file) {
  if (file.empty()) return std::nullopt;
  ShapeParams params;
  params.file = file;
  const geometry::Shape& part = compound.parts.front().shape;
  if (const auto* sphere = std::get_if<geometry::Sphere>(&part)) {
    params.type = ShapeType::kCloud;
    params.radius = sphere->radius;
  } else if (std::holds_alternative<geometry::ConvexMesh>(part)) {
    params.type = ShapeType::kMesh;
    params.collision = CollisionMeshes::kDecomposition;
  } else if (file.ends_with(".bt") || file.ends_with(".ot")) {
    params.type = ShapeType::kOctree;
  } else {
    return std::nullopt;  // a heightmap
  }
  return params;
}

}  // namespace

ShapeParams ShapeParamsOf(const ObstacleBody& body) {
  const geometry::Shape& shape = body.collider->shape();
  const auto* const compound = std::get_if<geometry::Compound>(&shape);
  if (compound != nullptr) {
    if (const auto params = FileParamsOf(*compound, body.file)) return *params;
  }
  ShapeParams params;
  static_cast<SolidParams&>(params) = SolidParamsOf(shape);
  if (params.file) params.file = body.file;
  if (compound != nullptr) {
    for (const geometry::CompoundPart& part : compound->parts) {
      params.parts.push_back({SolidParamsOf(part.shape), PoseParamsOf(part.X_SP)});
    }
  }
  return params;
}

}  // namespace oca::systems
