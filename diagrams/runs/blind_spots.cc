// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/blind_spots.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "oca/models/robot/robot_model.h"
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

bool HasShapes(const robot::RobotModel& model) {
  const auto& links = model.links();
  return std::any_of(links.begin(), links.end(), [](const robot::Link& link) {
    return !link.collisions.empty() || !link.visuals.empty();
  });
}

/// Models of the diagram that the file of a system that measures distances knows nothing of.
void AddModelsElsewhere(const loading::LoadedDiagram& loaded, const System& measuring,
                        std::vector<std::string>& spots) {
  const auto& known = loaded.BlockOf(measuring).models->all();
  for (const auto& [name, model] : loaded.models.all()) {
    if (known.contains(name) || !HasShapes(*model)) continue;
    spots.push_back(fmt::format("model '{}' (not known in the file of {})", name,
                                loaded.diagram->PathOf(measuring)));
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
  std::set<const System*> seen;
  for (const auto& judge : loaded.diagram->FindRoles<Judges>()) {
    const InputHandle& proximities = judge.role->proximities;
    AddSpotsBehind(*loaded.diagram, proximities, spots);
    if (proximities.system == nullptr) continue;
    const auto driver = loaded.diagram->DriverOf(proximities);
    if (!driver || driver->system->role<systems::MeasuresDistances>() == nullptr) continue;
    if (seen.insert(driver->system).second) AddModelsElsewhere(loaded, *driver->system, spots);
  }
  return spots;
}

}  // namespace oca::runs
