// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plan_wiring.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "framework/dynamic_port.h"
#include "framework/error.h"
#include "framework/port_access.h"
#include "systems/request_ahead.h"

namespace oca::tools {
namespace {

std::vector<OutputHandle> AheadOutputs(const System& system) {
  std::vector<OutputHandle> found;
  const auto& outputs = system.outputs();
  for (int i = 0; i < std::ssize(outputs); ++i) {
    if (outputs[i].type == &TypeOf<systems::RequestAhead>()) found.push_back({{&system, i}});
  }
  return found;
}

}  // namespace

std::string PlanWiring::NameOf(const System& system) const {
  for (const Diagram::Child& child : loaded_.diagram->children()) {
    if (child.system.get() == &system) return child.name;
  }
  return "?";
}

const diagrams::LoadedDiagram::Block& PlanWiring::BlockOf(const System& system) const {
  const std::string name = NameOf(system);
  return *std::find_if(loaded_.systems.begin(), loaded_.systems.end(),
                       [&](const auto& block) { return block.name == name; });
}

OutputHandle PlanWiring::DriverOf(const System& system, const std::string& input) const {
  const InputHandle handle = system.FindInput(input);
  for (const auto& [from, to] : loaded_.diagram->connections()) {
    if (to.system == handle.system && to.index == handle.index) return from;
  }
  return {};
}

std::vector<const System*> PlanWiring::Drivers(const System& system) const {
  std::vector<const System*> drivers;
  for (const auto& [from, to] : loaded_.diagram->connections()) {
    if (to.system == &system) drivers.push_back(from.system);
  }
  return drivers;
}

bool PlanWiring::TimeAlone(const OutputHandle& output) const {
  std::set<const System*> seen;
  std::vector<const System*> open{output.system};
  while (!open.empty()) {
    const System* const system = open.back();
    open.pop_back();
    if (!seen.insert(system).second) continue;
    if (!system->states().empty()) return false;
    for (const System* driver : Drivers(*system)) open.push_back(driver);
  }
  return true;
}

std::pair<std::shared_ptr<const systems::Trajectory>, std::string> PlanWiring::AheadOf(
    const OutputHandle& output, const std::string& where) const {
  std::set<const System*> seen;
  std::vector<const System*> level{output.system};
  while (!level.empty()) {
    std::vector<const System*> next;
    std::vector<OutputHandle> found;
    for (const System* const system : level) {
      if (!seen.insert(system).second) continue;
      for (const OutputHandle& ahead : AheadOutputs(*system)) found.push_back(ahead);
      for (const System* driver : Drivers(*system)) next.push_back(driver);
    }
    if (found.size() > 1) {
      throw ConfigError(fmt::format("{}: motion ahead; got both of '{}' and '{}'; expected one",
                                    where, NameOf(*found[0].system), NameOf(*found[1].system)));
    }
    if (found.size() == 1) {
      const Context context = loaded_.diagram->MakeContext();
      auto motion = Output<systems::RequestAhead>{found[0]}.Eval(context).trajectory;
      if (motion) return {std::move(motion), NameOf(*found[0].system)};
    }
    level = std::move(next);
  }
  throw ConfigError(fmt::format(
      "{}: motion ahead; got '{}', up the line from which nobody knows it; expected a source with "
      "the output `ahead`, as a SplineGenerator",
      where, NameOf(*output.system)));
}

}  // namespace oca::tools
