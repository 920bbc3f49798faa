// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/systems/signals/motion_metrics_value.h"
#include "oca/systems/signals/roles.h"

namespace oca::loading {
namespace {

/// Whether lengths of vectors do not fit.
bool IsOfSize(const WiringProblem& problem) {
  const auto* const words = std::get_if<std::string>(&problem.text.back());
  return words != nullptr &&
         (words->starts_with(": size; got") || words->starts_with(": initial value; got"));
}

}  // namespace

Assembly::Assembly(const Value& root, const Level& level, const SystemSources& sources,
                   Construction& construction, DiagramBuilder& builder, Problems& problems)
    : root_(root),
      level_(level),
      construction_(construction),
      builder_(builder),
      problems_(problems),
      systems_(root, level, sources, construction, builder, problems),
      connections_(root, level, systems_, construction, builder, problems) {}

void Assembly::ExportOffsets() {
  for (const auto& [name, system] : systems_.built()) {
    const auto* const holds = system->role<systems::HoldsObstacles>();
    if (holds == nullptr || holds->offsets.system == nullptr) continue;
    const auto index = static_cast<std::size_t>(holds->offsets.index);
    const std::string port = name + "." + holds->offsets.system->inputs()[index].name;
    if (construction_.connections.contains(port)) continue;
    builder_.ExportInput(port, holds->offsets);
  }
}

std::unique_ptr<Diagram> Assembly::Build(bool movable) {
  std::unique_ptr<Diagram> diagram;
  try {
    if (movable) ExportOffsets();
    diagram = builder_.Build();
    diagram->schedule().CheckStart(diagram->MakeContext(), false);
  } catch (const SimulationError& error) {  // a state starts where it cannot be
    construction_.AddStartProblem(error, problems_);
  } catch (const WiringError& error) {
    const bool counted = std::any_of(error.problems.begin(), error.problems.end(), IsOfSize) &&
                         systems_.TellWrongCounts(problems_);
    for (const WiringProblem& problem : error.problems) {
      if (counted && IsOfSize(problem)) continue;  // they follow
      construction_.AddWiringProblem(problem, root_.location(), problems_);
    }
  }
  return diagram;
}

files::NamedOutputs Assembly::Metrics() {
  files::NamedOutputs metrics;
  for (const auto& [name, system] : systems_.built()) {
    const auto* const judges = system->role<systems::Judges>();
    if (judges == nullptr) continue;
    try {
      Typed<systems::MotionMetricsValue>(judges->metrics);
      metrics.emplace_back(name, judges->metrics);
    } catch (const WiringError& error) {
      construction_.AddProblemOf(level_.Full(name), fmt::format("judge: {}", error.what()),
                                 problems_);
    }
  }
  return metrics;
}

}  // namespace oca::loading
