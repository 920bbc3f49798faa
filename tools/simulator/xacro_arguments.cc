// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/xacro_arguments.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"

namespace oca::tools {

robot::XacroArguments ParseXacroArguments(const std::vector<std::string>& words) {
  robot::XacroArguments arguments;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(fmt::format("--argument: got '{}'; expected NAME=VALUE", word));
    }
    if (!arguments.emplace(word.substr(0, equals), word.substr(equals + 1)).second) {
      throw ConfigError(
          fmt::format("--argument: got '{}' twice; expected it once", word.substr(0, equals)));
    }
  }
  return arguments;
}

std::map<std::string, robot::XacroArguments> ParseArgumentsOfModels(
    const std::vector<std::string>& words) {
  std::map<std::string, std::vector<std::string>> by_model;
  for (const std::string& word : words) {
    const std::size_t dot = word.find('.');
    if (dot == std::string::npos || dot == 0 || dot > word.find('=')) {
      throw ConfigError(fmt::format("--argument: got '{}'; expected MODEL.NAME=VALUE", word));
    }
    by_model[word.substr(0, dot)].push_back(word.substr(dot + 1));
  }
  std::map<std::string, robot::XacroArguments> arguments;
  for (const auto& [model, own] : by_model) arguments[model] = ParseXacroArguments(own);
  return arguments;
}

}  // namespace oca::tools
