// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdio>
#include <exception>

#include "oca/diagrams/foresight/time_steps.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/request_check.h"
#include "oca/diagrams/runs/run_warnings.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/systems/signals/roles.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

/// Of the inputs of all systems that something drives.
std::size_t CountConnections(const Diagram& diagram) {
  std::size_t count = 0;
  for (const Diagram::Leaf& leaf : diagram.systems()) {
    count += diagram.DriversOf(*leaf.system).size();
  }
  return count;
}

/// What systems have to say to who checks them.
void PrintNotes(const Diagram& diagram) {
  for (const auto& [path, system, remarks] : diagram.FindRoles<systems::Remarks>()) {
    if (!remarks->notes) continue;
    for (const std::string& note : remarks->notes()) Print("  {}: {}\n", path, note);
  }
}

/// Of a long run, what was not looked at.
void PrintLooks(double duration) {
  using Steps = foresight::TimeSteps;
  if (duration <= Steps::kEachUntil) return;
  const Steps steps(duration);
  Print(
      "  simulator.duration: what moves was sought at {} times up to {:g} s: each millisecond of "
      "the first {:g} s, then at intervals that grow with the time\n",
      steps.size(), duration, Steps::kEachUntil);
}

}  // namespace

int CheckCommand(const std::vector<std::string>& files, const std::vector<std::string>& texts,
                 const files::Catalogue& catalogue) {
  int status = kFine;
  for (const std::string& file : files) {
    try {
      std::vector<files::Override> overrides;
      for (const std::string& text : texts) overrides.push_back(files::Override::Parse(text));
      auto loaded = loading::LoadDiagram(file, overrides, catalogue);
      runs::AddRunWarnings(loaded);
      for (const std::string& warning : loaded.warnings) Tell("{}\n", warning);
      for (const std::string& warning : runs::RequestWarnings(loaded)) Tell("{}\n", warning);
      Print("{}: fine, {} systems, {} connections\n", file, loaded.systems.size(),
            CountConnections(*loaded.diagram));
      std::fflush(stdout);
      PrintNotes(*loaded.diagram);
      PrintLooks(loaded.simulator.duration);
    } catch (const std::exception& error) {
      Tell("{}\n", oca::internal::Explain(error));
      status = kBadInput;
    }
  }
  return status;
}

}  // namespace oca::tools
