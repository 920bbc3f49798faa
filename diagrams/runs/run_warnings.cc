// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/run_warnings.h"

#include <utility>

#include "oca/diagrams/runs/chatter_check.h"
#include "oca/diagrams/runs/own_links_check.h"

namespace oca::runs {

std::vector<std::string> RunWarnings(const loading::LoadedDiagram& loaded) {
  std::vector<std::string> warnings = OwnLinkWarnings(loaded);
  for (std::string& one : ChatterWarnings(loaded)) warnings.push_back(std::move(one));
  return warnings;
}

void AddRunWarnings(loading::LoadedDiagram& loaded) {
  for (std::string& one : RunWarnings(loaded)) loaded.warnings.push_back(std::move(one));
}

}  // namespace oca::runs
