// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/assembly.h"

#include <fmt/format.h>

#include "oca/diagrams/loading/loaded_diagram.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/systems/signals/motion_metrics_value.h"
#include "oca/systems/signals/roles.h"

namespace oca::loading {

Assembly::Assembly(const Value& root, const Part& part, const files::Catalogue& catalogue,
                   files::ModelSection& models, Problems& problems)
    : root_(root),
      part_(part),
      problems_(problems),
      systems_(root, part, catalogue, models, builder_, problems),
      connections_(root, part, systems_, builder_, problems) {}

void Assembly::ExportOutputs() {
  for (const auto& [name, output] : systems_.Outputs()) {
    builder_.ExportOutput(ExportedName(name), output);
  }
}

void Assembly::ExportOffsets() {
  for (const LoadedDiagram::Block& block : systems_.blocks()) {
    const auto* const holds = systems_.Find(block.name)->role<systems::HoldsObstacles>();
    if (holds == nullptr || holds->offsets.system == nullptr) continue;
    const auto index = static_cast<std::size_t>(holds->offsets.index);
    const std::string port = block.name + "." + holds->offsets.system->inputs()[index].name;
    if (!connections_.Drives(port)) builder_.ExportInput(ExportedName(port), holds->offsets);
  }
}

std::unique_ptr<Diagram> Assembly::Build(bool movable) {
  std::unique_ptr<Diagram> diagram;
  try {
    if (!part_.whole()) ExportOutputs();
    if (movable) ExportOffsets();
    diagram = builder_.Build();
    diagram->schedule().CheckStart(diagram->MakeContext(), false);
  } catch (const SimulationError& error) {  // a state starts where it cannot be
    problems_.Add(*systems_.LocationOf(error.system), error.what());
  } catch (const WiringError& error) {
    for (const std::string& problem : error.problems) problems_.Add(Place(problem), problem);
  }
  return diagram;
}

files::NamedOutputs Assembly::Metrics() {
  files::NamedOutputs metrics;
  for (const LoadedDiagram::Block& block : systems_.blocks()) {
    const auto* const judges = systems_.Find(block.name)->role<systems::Judges>();
    if (judges == nullptr) continue;
    try {
      Typed<systems::MotionMetricsValue>(judges->metrics);
      metrics.emplace_back(block.name, judges->metrics);
    } catch (const WiringError& error) {
      problems_.Add(*systems_.LocationOf(block.name),
                    fmt::format("systems.{}: judge: {}", block.name, error.what()));
    }
  }
  return metrics;
}

Location Assembly::Place(const std::string& problem) const {
  if (const Location* const connection = connections_.LocationOf(problem)) return *connection;
  const Location* const system = systems_.LocationOf(problem.substr(0, problem.find('.')));
  return system == nullptr ? root_.location() : *system;
}

}  // namespace oca::loading
