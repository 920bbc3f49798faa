// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "diagrams/loader.h"
#include "systems/trajectory.h"

namespace oca::tools {

/// Looks around in the wiring of a loaded file, which must outlive it.
class PlanWiring {
 public:
  explicit PlanWiring(const diagrams::LoadedDiagram& loaded) : loaded_(loaded) {}

  std::string NameOf(const System& system) const;
  const diagrams::LoadedDiagram::Block& BlockOf(const System& system) const;
  /// What drives an input; without a system: nothing.
  OutputHandle DriverOf(const System& system, const std::string& input) const;
  /// Whether nothing up the line, the system itself included, has a state.
  bool TimeAlone(const OutputHandle& output) const;
  /// The motion that the nearest system up the line knows ahead, and the name of that system.
  /// throws ConfigError, which begins with `where`, if there is none or two are equally near
  std::pair<std::shared_ptr<const systems::Trajectory>, std::string> AheadOf(
      const OutputHandle& output, const std::string& where) const;

 private:
  std::vector<const System*> Drivers(const System& system) const;

  const diagrams::LoadedDiagram& loaded_;
};

}  // namespace oca::tools
