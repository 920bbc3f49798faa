// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/json_reader.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/runs/evaluator.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/robot/urdf.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"
#include "tools/simulator/xacro_arguments.h"

namespace oca::tools {
namespace {

systems::ModelSet LoadModels(const EvalArguments& arguments) {
  systems::ModelSet models;
  auto given = ParseArgumentsOfModels(arguments.arguments);
  for (const std::string& argument : arguments.models) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(fmt::format("--model: got '{}'; expected NAME=URDF", argument));
    }
    robot::LoadOptions options;
    options.package_directories = files::PackageFolders();
    const std::string name = argument.substr(0, equals);
    options.xacro_arguments = std::exchange(given[name], {});
    options.warn = [&name](const std::string& line) {
      Tell("warning: --model {}: {}\n", name, line);
    };
    models.Add(name, std::make_shared<const robot::RobotModel>(robot::LoadUrdf(
                         files::ResolvePath(argument.substr(equals + 1), {}, {}), options)));
  }
  for (const auto& [name, unused] : given) {
    if (unused.empty()) continue;
    throw ConfigError(fmt::format("--argument: got '{}.{}'; expected a model that --model names",
                                  name, unused.begin()->first));
  }
  return models;
}

}  // namespace

int EvalCommand(const EvalArguments& arguments, const files::Catalogue& catalogue, std::istream& in,
                std::ostream& out) {
  if (arguments.type == files::kDiagramType) {
    throw ConfigError("eval: type; got Diagram, which is a file; expected a system of the list");
  }
  const files::CatalogueRow& row = *catalogue.Find(arguments.type);
  runs::Evaluator evaluator(row, files::ReadJson(arguments.params, "--params"),
                            LoadModels(arguments));
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::string answer;
    try {
      answer = evaluator.Serve(line);
    } catch (const std::exception& error) {
      answer = oca::internal::JsonText(nlohmann::json{{"error", oca::internal::Explain(error)}});
    }
    out << answer << std::endl;
    if (!out) return kRunFailed;  // nobody reads any more
  }
  return kFine;
}

}  // namespace oca::tools
