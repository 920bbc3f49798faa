// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/construction.h"

#include <fmt/format.h>

#include <cctype>

namespace oca::loading {
namespace {

/// A text with the paths below `use` as the file there has them.
std::string AsIn(const std::string& use, const std::string& text) {
  const std::string prefix = use + ".";
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const bool begins = i == 0 || (std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0 &&
                                   text[i - 1] != '_' && text[i - 1] != '.');
    if (begins && text.compare(i, prefix.size(), prefix) == 0) {
      i += prefix.size();
    } else {
      result += text[i++];
    }
  }
  return result;
}

/// The path of the system that a problem begins with: all of `left.plant.position: ...` but the
/// port.
std::string SystemIn(const std::string& problem) {
  const std::string port = problem.substr(0, problem.find_first_of(": "));
  return port.substr(0, port.rfind('.'));
}

/// The inputs that a problem leads through, `... -> a.in -> a.out -> b.in -> ...`, in order.
std::vector<std::string> InputsOnPath(const std::string& problem) {
  std::vector<std::string> ports;
  const std::string arrow = " -> ";
  for (std::size_t at = problem.find(arrow); at != std::string::npos;) {
    const std::size_t begin = at + arrow.size();
    ports.push_back(problem.substr(begin, problem.find_first_of(" ;", begin) - begin));
    at = problem.find(arrow, begin);
  }
  return ports;
}

}  // namespace

const Place* Construction::PlaceOfLoop(const std::string& problem) const {
  const Place* place = nullptr;
  for (const std::string& port : InputsOnPath(problem)) {
    const auto connection = connections.find(port);
    if (connection == connections.end()) continue;
    const Place& found = connection->second;
    if (place == nullptr || found.use.size() < place->use.size()) place = &found;
  }
  return place;
}

void Construction::Add(const Place& place, const std::string& what, Problems& into) {
  if (place.use.empty()) return into.Add(place.location, what);
  Problems one;
  one.Add(place.location, AsIn(place.use, what));
  problems.Add(place.use, one.all().front());
}

void Construction::AddProblemOf(const std::string& system, const std::string& what,
                                Problems& into) {
  Add(systems.at(system), what, into);
}

void Construction::AddWiringProblem(const std::string& problem, const Location& otherwise,
                                    Problems& into) {
  if (problem.starts_with("algebraic loop: ")) {
    const Place* const place = PlaceOfLoop(problem);
    return Add(place == nullptr ? Place{otherwise} : *place, problem, into);
  }
  for (const auto& [input, opened] : open) {
    if (!problem.starts_with(input + ": input not connected")) continue;
    return Add(opened.place, fmt::format("{}: {}", opened.name, problem), into);
  }
  for (const auto& [input, place] : connections) {
    if (problem.find("-> " + input + ":") != std::string::npos ||
        problem.starts_with(input + ":")) {
      return Add(place, problem, into);
    }
  }
  const auto system = systems.find(SystemIn(problem));
  Add(system == systems.end() ? Place{otherwise} : system->second, problem, into);
}

}  // namespace oca::loading
