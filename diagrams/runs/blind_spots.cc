// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/blind_spots.h"

#include <algorithm>
#include <set>

#include "oca/systems/signals/roles.h"

namespace oca::runs {
namespace {

using systems::Judges;

/// Those of what drives an input, and of what is behind that.
void AddSpotsBehind(const Diagram& diagram, InputHandle input, std::vector<std::string>& spots) {
  std::set<const System*> seen;
  while (input.system != nullptr) {
    const auto driver = diagram.DriverOf(input);
    if (!driver || !seen.insert(driver->system).second) return;
    const auto* const blind = driver->system->role<systems::BlindSpots>();
    if (blind == nullptr) return;
    for (std::string& spot : blind->spots(diagram.PathOf(*driver->system))) {
      if (std::find(spots.begin(), spots.end(), spot) == spots.end()) {
        spots.push_back(std::move(spot));
      }
    }
    input = blind->behind;
  }
}

}  // namespace

bool JudgesDistances(const loading::LoadedDiagram& loaded) {
  const auto judges = loaded.diagram->FindRoles<Judges>();
  return std::any_of(judges.begin(), judges.end(), [&](const auto& judge) {
    const InputHandle& proximities = judge.role->proximities;
    return proximities.system != nullptr && loaded.diagram->DriverOf(proximities);
  });
}

std::vector<std::string> BlindSpots(const loading::LoadedDiagram& loaded) {
  std::vector<std::string> spots;
  for (const auto& judge : loaded.diagram->FindRoles<Judges>()) {
    AddSpotsBehind(*loaded.diagram, judge.role->proximities, spots);
  }
  return spots;
}

}  // namespace oca::runs
