// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/systems/sensing/pose_params.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

enum class ShapeType {
  kSphere,
  kBox,
  kCylinder,
  kCapsule,
  kMesh,
  kCone,
  kEllipsoid,
  kHalfSpace,
  kCompound,
  kCloud,
  kHeightmap,
  kOctree
};
inline constexpr std::array kShapeTypeNames{"sphere",   "box",   "cylinder",  "capsule",
                                            "mesh",     "cone",  "ellipsoid", "half_space",
                                            "compound", "cloud", "heightmap", "octree"};
inline std::span<const char* const> EnumNames(ShapeType) { return kShapeTypeNames; }

/// What files call it.
std::string_view NameOf(const geometry::Shape& shape);

/// What a mesh counts as: its convex hull, or convex parts that keep its hollows.
enum class CollisionMeshes { kHull, kDecomposition };
inline std::span<const char* const> EnumNames(CollisionMeshes) {
  static constexpr std::array kNames{"hull", "decomposition"};
  return kNames;
}

/// A convex shape as files and JSON give it: a type, and just those sizes that the type has.
struct SolidParams {
  ShapeType type{ShapeType::kSphere};
  std::optional<double> radius{};
  std::optional<double> length{};
  std::optional<Eigen::Vector3d> size{};
  std::optional<Eigen::Vector3d> radii{};
  std::optional<std::string> file{};
  static void Describe(Fields<SolidParams>& fields);
};

/// A part of a compound, and where it is in the frame of the compound.
struct PartParams {
  SolidParams shape{};
  std::optional<PoseParams> pose{};
  static void Describe(Fields<PartParams>& fields);
};

/// Any shape; a compound has parts and no sizes. A cloud, heightmap, octree or decomposed mesh
/// becomes a compound of balls, boxes or hulls.
struct ShapeParams : SolidParams {
  std::vector<PartParams> parts{};
  std::optional<double> cell{};
  std::optional<double> scale{};
  std::optional<CollisionMeshes> collision{};
  static void Describe(Fields<ShapeParams>& fields);
};

/// Prepares an obstacle for distance queries; reads the file if it has one. `warnings` (may be
/// null) gets a line for each mesh whose hull adds volume. throws ConfigError naming `where` for a
/// missing, surplus or bad size, or a bad file
std::shared_ptr<const ObstacleBody> MakeObstacleBody(const std::string& id,
                                                     const ShapeParams& shape,
                                                     const std::string& where,
                                                     std::vector<std::string>* warnings = nullptr);

/// The inverse: the parameters that an obstacle was made from; of a heightmap, those of the
/// compound that it became.
ShapeParams ShapeParamsOf(const ObstacleBody& body);

}  // namespace oca::systems
