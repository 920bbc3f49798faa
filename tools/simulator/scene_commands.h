// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace oca::tools {

/// Adds `import` and `scenes`. A chosen command puts what it does into `command`.
void AddSceneCommands(CLI::App& app, std::function<int()>& command);

}  // namespace oca::tools
