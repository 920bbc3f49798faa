// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/construction.h"

#include <fmt/format.h>

namespace oca::loading {

const Place* Construction::PlaceOfConnection(const WiringProblem& problem) const {
  const Place* place = nullptr;
  for (const PortPath& input : problem.inputs) {
    const auto connection = connections.find(input.ToString());
    if (connection == connections.end()) continue;
    const Place& found = connection->second;
    if (place == nullptr || found.use.size() < place->use.size()) place = &found;
  }
  return place;
}

void Construction::Add(const Place& place, const std::string& what, Problems& into) {
  if (place.use.empty()) return into.Add(place.location, what);
  problems.Add(place.use, {place.location, what});
}

void Construction::AddWiringProblem(const WiringProblem& problem, const Location& otherwise,
                                    Problems& into) {
  if (const Place* const place = PlaceOfConnection(problem)) {
    return Add(*place, problem.ToString(place->use), into);
  }
  for (const PortPath& input : problem.inputs) {
    const auto opened = open.find(input.ToString());
    if (opened == open.end()) continue;
    const auto& [place, name] = opened->second;
    return Add(place, fmt::format("{}: {}", name, problem.ToString(place.use)), into);
  }
  const auto system = systems.find(problem.system);
  const Place place = system == systems.end() ? Place{otherwise} : system->second;
  Add(place, problem.ToString(place.use), into);
}

void Construction::AddStartProblem(const SimulationError& error, Problems& into) {
  const Place& place = systems.at(error.system);
  const std::string state = PortPath{error.system, error.port}.ToString(place.use);
  Add(place, fmt::format("{} at t = {} s: {}", state, error.time, error.reason), into);
}

void Construction::AddProblemOf(const std::string& system, const std::string& what,
                                Problems& into) {
  const Place& place = systems.at(system);
  Add(place, fmt::format("systems.{}: {}", PathIn(place.use, system), what), into);
}

}  // namespace oca::loading
