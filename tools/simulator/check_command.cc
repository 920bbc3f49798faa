// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <exception>
#include <iostream>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run_warnings.h"
#include "oca/systems/signals/roles.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

/// Of the inputs of all systems that something drives.
std::size_t CountConnections(const Diagram& diagram) {
  std::size_t count = 0;
  for (const Diagram::Leaf& leaf : diagram.systems()) {
    const int inputs = static_cast<int>(leaf.system->inputs().size());
    for (int i = 0; i < inputs; ++i) count += diagram.DriverOf({{leaf.system, i}}) ? 1 : 0;
  }
  return count;
}

/// What systems have to say to who checks them.
void PrintNotes(const Diagram& diagram) {
  for (const auto& [path, system, remarks] : diagram.FindRoles<systems::Remarks>()) {
    if (!remarks->notes) continue;
    for (const std::string& note : remarks->notes()) Print("  {}: {}\n", path, note);
  }
}

}  // namespace

int CheckCommand(const std::vector<std::string>& files, const std::vector<std::string>& texts,
                 const files::Catalogue& catalogue) {
  int status = kFine;
  for (const std::string& file : files) {
    try {
      std::vector<files::Override> overrides;
      for (const std::string& text : texts) overrides.push_back(files::Override::Parse(text));
      auto loaded = loading::LoadDiagram(file, overrides, catalogue);
      runs::AddRunWarnings(loaded);
      for (const std::string& warning : loaded.warnings) std::cerr << warning << '\n';
      std::cout << file << ": fine, " << loaded.systems.size() << " systems, "
                << CountConnections(*loaded.diagram) << " connections\n"
                << std::flush;
      PrintNotes(*loaded.diagram);
    } catch (const std::exception& error) {
      std::cerr << error.what() << '\n';
      status = kBadInput;
    }
  }
  return status;
}

}  // namespace oca::tools
