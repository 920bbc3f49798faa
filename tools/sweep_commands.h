// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace oca::tools {

/// Adds `sweep` and `merge`. A chosen one puts what it does into `command`.
void AddSweepCommands(CLI::App& app, std::function<int()>& command);

}  // namespace oca::tools
