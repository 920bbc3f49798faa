// SPDX-License-Identifier: BSD-3-Clause
#include <exception>
#include <iostream>

#include "diagrams/loader.h"
#include "tools/commands.h"

namespace oca::tools {

int CheckCommand(const std::vector<std::string>& files) {
  int status = kFine;
  for (const std::string& file : files) {
    try {
      const auto loaded = diagrams::LoadDiagram(file);
      for (const std::string& warning : loaded.warnings) std::cerr << warning << '\n';
      std::cout << file << ": fine, " << loaded.systems.size() << " systems, "
                << loaded.diagram->connections().size() << " connections\n";
    } catch (const std::exception& error) {
      std::cerr << error.what() << '\n';
      status = kBadInput;
    }
  }
  return status;
}

}  // namespace oca::tools
