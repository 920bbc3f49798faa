// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/blind_spots.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "oca/diagrams/foresight/sources_of.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/signals/roles.h"

namespace oca::runs {
namespace {

using systems::Judges;
using systems::MeasuresDistances;

bool HasShapes(const robot::RobotModel& model) {
  const auto& links = model.links();
  return std::any_of(links.begin(), links.end(), [](const robot::Link& link) {
    return !link.collisions.empty() || !link.visuals.empty();
  });
}

/// Looks for blind spots up the line.
class Spots {
 public:
  explicit Spots(const loading::LoadedDiagram& loaded) : loaded_(loaded) {
    const auto& models = loaded.models.all();
    one_robot_ = std::count_if(models.begin(), models.end(), [](const auto& named) {
                   return named.second->num_positions() > 0;
                 }) < 2;
  }

  /// Those of the systems that an input's values come from, and of what is behind these.
  void AddBehind(const InputHandle& input) {
    for (const OutputHandle& source :
         foresight::SourcesOf(*loaded_.diagram, input, [](const System& system) {
           return system.role<systems::BlindSpots>() != nullptr ||
                  system.role<MeasuresDistances>() != nullptr;
         })) {
      if (seen_.insert(source.system).second) AddOf(*source.system);
    }
  }

  std::vector<std::string> found() { return std::move(found_); }

 private:
  void AddOf(const System& system) {
    if (const auto* const blind = system.role<systems::BlindSpots>()) {
      for (std::string& spot : blind->spots(loaded_.diagram->PathOf(system), one_robot_)) {
        if (std::find(found_.begin(), found_.end(), spot) == found_.end()) {
          found_.push_back(std::move(spot));
        }
      }
      AddBehind(blind->behind);
    }
    if (system.role<MeasuresDistances>() != nullptr) AddModelsElsewhere(system);
  }

  /// Models of the diagram that the file of a system that measures distances knows nothing of.
  void AddModelsElsewhere(const System& measuring) {
    const auto& known = loaded_.BlockOf(measuring).models->all();
    for (const auto& [name, model] : loaded_.models.all()) {
      if (known.contains(name) || !HasShapes(*model)) continue;
      found_.push_back(fmt::format("model '{}' (not known in the file of {})", name,
                                   loaded_.diagram->PathOf(measuring)));
    }
  }

  const loading::LoadedDiagram& loaded_;
  bool one_robot_;
  std::set<const System*> seen_;
  std::vector<std::string> found_;
};

}  // namespace

bool JudgesDistances(const loading::LoadedDiagram& loaded) {
  const auto judges = loaded.diagram->FindRoles<Judges>();
  return std::any_of(judges.begin(), judges.end(), [&](const auto& judge) {
    const InputHandle& proximities = judge.role->proximities;
    return proximities.system != nullptr && loaded.diagram->DriverOf(proximities);
  });
}

std::vector<std::string> BlindSpots(const loading::LoadedDiagram& loaded) {
  Spots spots(loaded);
  for (const auto& judge : loaded.diagram->FindRoles<Judges>()) {
    spots.AddBehind(judge.role->proximities);
  }
  return spots.found();
}

}  // namespace oca::runs
