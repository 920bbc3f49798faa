// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/models/robot/urdf.h"

namespace CLI {
class App;
}

namespace oca::tools {

/// Which robot a command looks at, and how it is read.
struct RobotArguments {
  std::string urdf;                    ///< or xacro: path or package://NAME/PATH
  std::vector<std::string> arguments;  ///< NAME=VALUE, of a xacro
  std::string visual_as_collision{"none"};
};
/// Adds their options to `command`.
void AddRobotOptions(CLI::App& command, RobotArguments& arguments);

/// Packages are looked up as diagram files do, then near the robot's file. throws ConfigError for
/// what is no such value
robot::LoadOptions LoadOptionsOf(const RobotArguments& arguments);

}  // namespace oca::tools
