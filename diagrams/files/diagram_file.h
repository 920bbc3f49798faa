// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/sensing/geometry_params.h"

namespace oca::files {

/// The type of a system that is a diagram file itself, which this one uses.
inline constexpr const char* kDiagramType = "Diagram";

/// An entry of `attached` of a model: a tool or a grasped object.
struct AttachedParams {
  std::string id{};
  std::string link{};
  systems::ShapeParams shape{};
  std::optional<systems::PoseParams> pose{};
  std::vector<std::string> touches{};
  static void Describe(Fields<AttachedParams>& fields);
};

/// The values that a xacro file is given; in a diagram file a map of texts, numbers and booleans.
struct XacroArguments {
  robot::XacroArguments texts{};
};

/// Where joints are that a task does not move; in a diagram file one map: numbers, rad or m, by the
/// name of a joint, names of states by that of a group.
struct HeldParams {
  std::map<std::string, double> positions{};
  std::map<std::string, std::string> states{};
};

/// An entry of `models`: of urdf and xacro one is given.
struct ModelParams {
  std::string urdf{};
  std::string xacro{};  ///< in place of urdf
  XacroArguments arguments{};
  std::string srdf{};
  std::string group{};  ///< of the SRDF; all joints outside are held
  HeldParams held{};
  systems::CollisionMeshes collision{systems::CollisionMeshes::kHull};  ///< of its meshes
  robot::VisualAsCollision visual_as_collision{robot::VisualAsCollision::kNone};
  systems::PoseParams base_pose{};
  std::optional<PerComponent> acceleration_limits{};
  std::optional<PerComponent> jerk_limits{};
  std::string joint_limits{};  ///< a file
  std::vector<AttachedParams> attached{};
  static void Describe(Fields<ModelParams>& fields);
};

/// The file that a model is read from, urdf or xacro. throws ConfigError if it is not one of them,
/// by the ending of its name
const std::string& DescriptionOf(const ModelParams& params);

/// A key with its meaning.
struct Section {
  const char* key;
  const char* meaning;
};
/// The keys of a diagram file; their order is that of the schema.
const std::vector<Section>& Sections();

/// What a system of type kDiagramType is, and its keys beside `type`.
inline constexpr const char* kDiagramSummary = "is a diagram file that this one uses";
const std::vector<Section>& DiagramKeys();

}  // namespace oca::files

namespace oca {

template <>
const ParamType& ParamTypeOf<files::XacroArguments>();
template <>
const ParamType& ParamTypeOf<files::HeldParams>();

}  // namespace oca
