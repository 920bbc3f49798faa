// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace oca::files {
class Catalogue;
}  // namespace oca::files

namespace oca::tools {

/// Adds `sweep` and `merge`. A chosen one puts what it does into `command`. `catalogue`, which has
/// the types of the systems, must outlive it.
void AddSweepCommands(CLI::App& app, std::function<int()>& command,
                      const files::Catalogue& catalogue);

}  // namespace oca::tools
