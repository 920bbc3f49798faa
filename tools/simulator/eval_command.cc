// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/json_reader.h"
#include "oca/diagrams/files/load_models.h"
#include "oca/diagrams/runs/evaluator.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/robot/xacro.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"
#include "tools/simulator/xacro_arguments.h"

namespace oca::tools {
namespace {

/// `text`: a file, or the entry of `models` of a diagram file as JSON.
files::ModelParams ModelFrom(const std::string& name, const std::string& text,
                             robot::XacroArguments arguments) {
  files::ModelParams params;
  if (text.starts_with('{')) {
    const std::string where = "--model " + name;
    params = ReadParams<files::ModelParams>(files::ReadJson(text, where), where);
  } else {
    (robot::IsXacro(text) ? params.xacro : params.urdf) = text;
  }
  params.arguments.texts.merge(arguments);
  return params;
}

/// What `load` throws says first, in each line, that --model names `name`.
template <class Load>
auto OfModel(const std::string& name, const Load& load) {
  try {
    return load();
  } catch (const Error& error) {
    std::istringstream lines(error.what());
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      text += fmt::format("{}--model {}: {}", text.empty() ? "" : "\n", name, line);
    }
    throw ConfigError(text);
  }
}

systems::ModelSet LoadModels(const EvalArguments& arguments) {
  systems::ModelSet models;
  const auto tell = [](const std::string& line) { Tell("warning: {}\n", line); };
  auto given = ParseArgumentsOfModels(arguments.arguments);
  for (const std::string& argument : arguments.models) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(fmt::format("--model: got '{}'; expected NAME=URDF", argument));
    }
    const std::string name = argument.substr(0, equals);
    const files::ModelParams params =
        ModelFrom(name, argument.substr(equals + 1), std::exchange(given[name], {}));
    const auto loaded = OfModel(name, [&] { return files::LoadModels({{name, params}}, tell); });
    models.Add(name, loaded.Get(name));
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
  if (&in == &std::cin && std::ferror(stdin) != 0) {
    throw ConfigError("standard input: cannot be read; expected lines of JSON");
  }
  return kFine;
}

}  // namespace oca::tools
