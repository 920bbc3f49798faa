// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/robot_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "oca/diagrams/files/package_paths.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/xacro_arguments.h"

namespace oca::tools {
namespace {

robot::VisualAsCollision VisualsFrom(const std::string& name) {
  const auto names = EnumNames(robot::VisualAsCollision{});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw ConfigError(fmt::format("--visual-as-collision: got '{}'; expected one of: {}", name,
                                  fmt::join(names, ", ")));
  }
  return static_cast<robot::VisualAsCollision>(found - names.begin());
}

}  // namespace

void AddRobotOptions(CLI::App& command, RobotArguments& arguments) {
  command.add_option("URDF", arguments.urdf, "or xacro: path or package://NAME/PATH")->required();
  command.add_option("--argument", arguments.arguments, "NAME=VALUE: argument of a xacro")
      ->allow_extra_args(false);
  command
      .add_option("--visual-as-collision", arguments.visual_as_collision,
                  "links that take what is drawn of them as collision shapes: none, missing, all")
      ->capture_default_str();
}

robot::LoadOptions LoadOptionsOf(const RobotArguments& arguments) {
  robot::LoadOptions options;
  options.package_directories = files::PackageFolders();
  options.package_advice = files::kPackageAdvice;
  options.find_package =
      [robot = files::ResolvePath(arguments.urdf, {}, {})](const std::string& package) {
        return files::PackageFor(robot, package);
      };
  options.visual_as_collision = VisualsFrom(arguments.visual_as_collision);
  options.xacro_arguments = ParseXacroArguments(arguments.arguments);
  return options;
}

}  // namespace oca::tools
