// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "oca/models/geometry/mesh.h"
#include "oca/models/geometry/shape.h"

namespace oca::scenes {

/// A mesh that a scene names: as MoveIt writes it, package://, file:// or a path.
struct MeshResource {
  std::string name{};
  Eigen::Vector3d scale{Eigen::Vector3d::Ones()};
};

/// All points with a x + b y + c z + d = 0; (a, b, c) is not zero.
struct ScenePlane {
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};  ///< of unit length
  double offset{0.0};                                ///< m; n . p = offset
};

/// One of the bodies that an object consists of.
struct SceneBody {
  std::variant<geometry::Shape, geometry::TriangleMesh, MeshResource, ScenePlane> shape{};
  Eigen::Isometry3d X_OB{Eigen::Isometry3d::Identity()};  ///< in the object's frame
  std::string where{};                                    ///< "file:line"
};

/// A name of something else, and where it is said.
struct PlacedName {
  std::string text{};
  std::string where{};  ///< "file:line"
};

struct SceneFrame {
  std::string name{};
  std::string parent{};  ///< empty: the frame of the scene, or of the object
  Eigen::Isometry3d X_PF{Eigen::Isometry3d::Identity()};
  std::string where{};
};

struct SceneObject {
  std::string id{};
  PlacedName frame{};                                     ///< empty: the frame of the scene
  Eigen::Isometry3d X_FO{Eigen::Isometry3d::Identity()};  ///< in that frame
  std::vector<SceneBody> bodies{};                        ///< at least one
  std::vector<SceneFrame> subframes{};
  std::string where{};
};

/// An object that a link carries.
struct HeldSceneObject {
  PlacedName link{};
  SceneObject object{};
  std::vector<PlacedName> touch_links{};
};

/// Where joints are, rad or m, by name.
struct JointPositions {
  std::vector<std::pair<std::string, double>> positions{};
  std::vector<SceneFrame> bases{};  ///< of joints of several numbers: where they lead to
  bool differs{false};              ///< is_diff: the rest is as before
  std::string where{};              ///< empty: nothing was said

  const double* Find(const std::string& joint) const;
};

/// Names of links and objects that may touch; an entry with one name: whatever it is.
struct AllowedCollisions {
  std::vector<std::pair<std::string, std::string>> pairs{};
  std::vector<std::string> defaults{};
  std::string where{};
};

/// What MoveIt calls a planning scene, as far as it says where things are.
struct PlanningScene {
  std::string file{};
  std::string name{};
  std::string robot{};  ///< as the file names it
  std::vector<SceneObject> objects{};
  std::vector<HeldSceneObject> held{};
  std::vector<SceneFrame> frames{};
  JointPositions joints{};
  AllowedCollisions allowed{};
  /// What the file says and a scene does not hold, a line each: `file:line: what: why`.
  std::vector<std::string> notes{};
};

/// Reads a planning scene: YAML, as MoveIt's messages print (lists or maps of numbers, as
/// MotionBenchMaker and rostopic write), or, of a file named .scene, MoveIt's text format.
///
/// throws ModelError, a line for each `file:line: what; got X; expected Y`: for what is not of the
///        format; a type of primitive that there is not; sizes that are not finite, above zero and
///        of the right number; quaternions that are not of length 1 (to three digits); ids and
///        names that are there twice or empty; poses that do not fit the shapes in number; joints
///        and positions of different number
/// source moveit_msgs PlanningScene, CollisionObject, AttachedCollisionObject,
///        AllowedCollisionMatrix; shape_msgs SolidPrimitive, Mesh, Plane; MoveIt,
///        planning_scene.cpp, saveGeometryToStream
PlanningScene ReadPlanningScene(const std::filesystem::path& file);

}  // namespace oca::scenes
