// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/models/robot/xacro.h"

namespace oca::tools {

/// What `--argument NAME=VALUE` says, each name once. throws ConfigError
robot::XacroArguments ParseXacroArguments(const std::vector<std::string>& words);

/// What `--argument MODEL.NAME=VALUE` says, by model. throws ConfigError
std::map<std::string, robot::XacroArguments> ParseArgumentsOfModels(
    const std::vector<std::string>& words);

}  // namespace oca::tools
