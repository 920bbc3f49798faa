// SPDX-License-Identifier: BSD-3-Clause
// Ports of the systems of a file, by name, through the files that it uses.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "oca/diagrams/loading/assembly.h"
#include "oca/diagrams/loading/system_section.h"
#include "oca/diagrams/loading/used_file.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::loading {
namespace {

template <class Ports>
const auto& FindNamed(const Ports& ports, const std::string& file, const char* kind,
                      const std::string& name) {
  if (const auto found = ports.find(name); found != ports.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& port : ports) names.push_back(port.first);
  throw WiringError(fmt::format(
      "no {0} '{1}' of {2}{3}; its {0}s are: {4}", kind, name, file, DidYouMean(name, names),
      names.empty() ? "(none)" : fmt::format("{}", fmt::join(names, ", "))));
}

/// `name.port` of all that was made; ports_of(system) or ports_of(used file) are its ports.
template <class Made, class PortsOf>
std::vector<std::string> PortNames(const Made& all, const PortsOf& ports_of) {
  std::vector<std::string> names;
  for (const auto& [name, made] : all) {
    if (made.system != nullptr) {
      for (const auto& port : ports_of(*made.system)) names.push_back(name + "." + port.name);
    } else {
      for (const auto& port : ports_of(*made.file)) names.push_back(name + "." + port.first);
    }
  }
  return names;
}

/// Calls find(); an error begins with the name of the system.
template <class Find>
auto InSystem(const std::string& name, const Find& find) {
  try {
    return find();
  } catch (const WiringError& error) {
    throw WiringError(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace

SystemSection::Followed SystemSection::Follow(const std::string& path) const {
  const std::size_t dot = path.find('.');
  Followed followed{path.substr(0, dot), nullptr, path.substr(dot + 1)};
  if (const auto found = made_.find(followed.name); found != made_.end()) {
    followed.made = &found->second;
  } else if (!Names(followed.name)) {
    throw WiringError(
        fmt::format("no system '{}'{}", followed.name, DidYouMean(followed.name, names_)));
  }
  return followed;
}

std::optional<OutputAt> SystemSection::FindOutput(const std::string& path) const {
  const auto [name, made, port] = Follow(path);
  if (made == nullptr) return std::nullopt;
  return InSystem(name, [&, &made = made, &port = port]() -> std::optional<OutputAt> {
    if (made->system != nullptr) {
      return OutputAt{made->system->FindOutput(port), level_.Full(path), made->built};
    }
    if (port.find('.') != std::string::npos) {
      return made->file->assembly().systems().FindOutput(port);
    }
    return FindNamed(made->file->outputs(), made->file->file(), "output", port);
  });
}

std::optional<std::vector<InputAt>> SystemSection::FindInputs(const std::string& path) const {
  const auto [name, made, port] = Follow(path);
  if (made == nullptr) return std::nullopt;
  return InSystem(name, [&, &made = made, &port = port]() -> std::vector<InputAt> {
    if (made->system == nullptr) {
      return FindNamed(made->file->inputs(), made->file->file(), "input", port);
    }
    std::vector<InputAt> found;  // one
    found.push_back({made->system->FindInput(port), level_.Full(path), made->built});
    return found;
  });
}

std::vector<std::string> SystemSection::OutputNames() const {
  return PortNames(
      made_, [](const auto& owner) -> const auto& { return owner.outputs(); });
}

std::vector<std::string> SystemSection::InputNames() const {
  return PortNames(
      made_, [](const auto& owner) -> const auto& { return owner.inputs(); });
}

}  // namespace oca::loading
