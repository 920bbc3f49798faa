// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace oca::tools {

/// Adds `export`, `compare` and `plot`. A chosen one puts what it does into `command`.
void AddRecordCommands(CLI::App& app, std::function<int()>& command);

struct PlotArguments {
  std::vector<std::string> records;
  std::vector<std::string> signals;  ///< patterns; a panel each
  std::string figure;                ///< ready-made; empty: none
  std::string output;                ///< .svg or .png
};
int PlotCommand(const PlotArguments& arguments);

}  // namespace oca::tools
