// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <iostream>

#include "diagrams/chatter_check.h"
#include "diagrams/loader.h"
#include "models/robot/robot_model.h"
#include "systems/safety_filter.h"
#include "tools/commands.h"
#include "tools/terminal.h"

namespace oca::tools {
namespace {

/// What the ticks of a safety filter cost, at three speeds.
void PrintMargins(const std::string& name, const systems::SafetyFilter& filter) {
  const double reach = filter.Reach();
  const double fastest = filter.model().velocity_limits().sum();
  Print(
      "  {}: keeps {} m, less {:.3g} m while its joint speeds add up to 1 rad/s, {:.3g} m "
      "with obstacles at 1 m/s besides",
      name, filter.params().safe_distance, filter.TickMargin(1.0, reach, 0.0),
      filter.TickMargin(1.0, reach, 1.0));
  if (std::isfinite(fastest)) {
    Print(", {:.3g} m with all joints at their limits", filter.TickMargin(fastest, reach, 0.0));
  }
  Print("\n");
}

}  // namespace

int CheckCommand(const std::vector<std::string>& files, const std::vector<std::string>& texts,
                 const diagrams::Catalogue& catalogue) {
  int status = kFine;
  for (const std::string& file : files) {
    try {
      std::vector<diagrams::Override> overrides;
      for (const std::string& text : texts) overrides.push_back(diagrams::Override::Parse(text));
      auto loaded = diagrams::LoadDiagram(file, overrides, catalogue);
      diagrams::AddChatterWarnings(loaded);
      for (const std::string& warning : loaded.warnings) std::cerr << warning << '\n';
      std::cout << file << ": fine, " << loaded.systems.size() << " systems, "
                << loaded.diagram->connections().size() << " connections\n"
                << std::flush;
      for (const auto& block : loaded.systems) {
        const System* const system = loaded.diagram->FindSystem(block.name);
        if (const auto* filter = dynamic_cast<const systems::SafetyFilter*>(system)) {
          PrintMargins(block.name, *filter);
        }
      }
    } catch (const std::exception& error) {
      std::cerr << error.what() << '\n';
      status = kBadInput;
    }
  }
  return status;
}

}  // namespace oca::tools
