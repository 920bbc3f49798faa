// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/loaded_diagram.h"

#include <algorithm>

#include "oca/systems/signals/roles.h"

namespace oca::loading {

const LoadedDiagram::Block& LoadedDiagram::BlockOf(const System& system) const {
  const std::string path = diagram->PathOf(system);
  return *std::find_if(systems.begin(), systems.end(),
                       [&](const Block& block) { return block.name == path; });
}

std::string OverridePath(const std::string& path) {
  const std::size_t name = path.rfind('.') + 1;  // 0 if there is no dot
  return path.substr(0, name) + "systems." + path.substr(name);
}

std::vector<std::string> InsideOf(const Diagram& whole) {
  std::vector<std::string> inside;
  for (const auto& [path, system] : whole.systems()) {
    if (system->role<systems::Boundary>() == nullptr) inside.push_back(path);
  }
  return inside;
}

}  // namespace oca::loading
