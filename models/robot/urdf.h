// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "oca/models/robot/hold_joints.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/xacro.h"

namespace oca::robot {

/// Which links take what is drawn of them, hulls of meshes like those of collision meshes, as their
/// collision shapes: none, those without any, or all that are drawn.
enum class VisualAsCollision { kNone, kMissing, kAll };
inline std::span<const char* const> EnumNames(VisualAsCollision) {
  static constexpr std::array kNames{"none", "missing", "all"};
  return kNames;
}

/// What a robot's description leaves open.
struct LoadOptions {
  /// Pose of the root link in the world.
  Eigen::Isometry3d X_WB{Eigen::Isometry3d::Identity()};
  /// SRDF file with the pairs of links that are never checked for collision, groups and states;
  /// empty: none.
  std::filesystem::path srdf{};
  /// rad/s^2 or m/s^2, rad/s^3 or m/s^3, more than 0: one for all, or one a position; empty: as in
  /// the URDF's <limit acceleration jerk>, unlimited where it has none.
  Eigen::VectorXd acceleration_limits{};
  Eigen::VectorXd jerk_limits{};
  /// File of joint limits as MoveIt writes it, which may narrow all of these; empty: none.
  std::filesystem::path joint_limits{};
  /// Joints that are made fixed ones: no positions of the robot, which the limits above know.
  HeldJoints held{};
  /// package://NAME/rest is looked up as find_package(NAME)/rest if that is set and not empty, then
  /// as DIR/NAME/rest for each DIR.
  std::function<std::filesystem::path(const std::string& package)> find_package{};
  std::vector<std::filesystem::path> package_directories{};
  std::string package_advice{};  ///< ends messages about packages that are nowhere
  /// true: a collision mesh counts as the compound that LoadDecomposition makes of it, which keeps
  /// its hollows, instead of its convex hull.
  bool decompose_meshes{false};
  VisualAsCollision visual_as_collision{VisualAsCollision::kNone};
  /// Take what is odd but does not matter, or unset: `warn` a line a kind, which names the first of
  /// it and counts the rest, `warn_each` a line for each thing. Meshes whose hull adds volume,
  /// `link 'x': collision mesh ...` or `visual mesh`, and flat ones, are of two kinds that name the
  /// links of the rest; limits that hardly mean what they say (LimitWarnings) have lines of their
  /// own: `joint X: ...`. The line of a hull ends with `hull_advice`.
  std::function<void(const std::string&line)> warn{}, warn_each{};
  std::string hull_advice{};
  /// false: meshes that are only drawn need not exist, and their elements name no file.
  bool load_visuals{true};
  /// Of a xacro file.
  XacroArguments xacro_arguments{};
};

/// Reads a robot, or a world of fixed links, from a URDF file, or from a xacro file, by the ending
/// .xacro, which it expands first. Relative mesh paths are relative to the file's folder. Links are
/// numbered depth first, children in the order of the file's joints. A cylinder with a sphere of
/// the same radius at either end becomes one Capsule.
///
/// throws ModelError naming file, line and element, for all that a robot cannot be built from or
/// that would be lost in silence: see ReadUrdfOutline and CheckUrdfTree; beyond these an unreadable
/// or malformed file, a missing mesh, a wrong number of acceleration limits, arguments of a file
/// that is no xacro. What is wrong with an expanded file is told with the places in the xacro files
/// source https://wiki.ros.org/urdf/XML
RobotModel LoadUrdf(const std::filesystem::path& file, const LoadOptions& options = {});

/// What LoadUrdf expands a xacro file with.
XacroOptions ForXacro(const LoadOptions& options);

/// The same from text. `name` stands for the file in messages; relative mesh paths are relative to
/// `directory`.
RobotModel ParseUrdf(const std::string& text, const std::string& name,
                     const LoadOptions& options = {}, const std::filesystem::path& directory = {});

}  // namespace oca::robot
