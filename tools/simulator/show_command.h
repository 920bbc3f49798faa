// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace oca::tools {

/// Adds `robot show` to the commands of `robot`; the one that is chosen goes to `command`.
void AddShow(CLI::App& robot, std::function<int()>& command);

}  // namespace oca::tools
