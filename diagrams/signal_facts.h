// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagrams/loader.h"
#include "framework/context.h"
#include "models/robot/robot_model.h"

namespace oca::diagrams {

/// What a record says of the Vector outputs of a diagram beyond their numbers: their units, settled
/// along the connections, and whose joints they are.
class SignalFacts {
 public:
  SignalFacts(const LoadedDiagram& loaded, const Context& context);

  /// As in `rad/s^2`; empty if nothing says it.
  std::string UnitOf(const OutputHandle& output) const;
  /// The robot that an output has one number a position for, by its name among the models; empty if
  /// it is none's.
  std::string RobotOf(const OutputHandle& output) const;
  /// Names of that robot's joints, one an element of the output; empty if it is none's.
  std::vector<std::string> JointsOf(const OutputHandle& output) const;
  /// What drives an input of a system; nothing if it is not connected or there is none.
  std::optional<OutputHandle> DriverOf(const std::string& system, const std::string& input) const;
  /// `system.output`
  std::string NameOf(const OutputHandle& output) const;
  /// The outputs of systems of a type (any: empty) whose signals are of a type, by name.
  std::vector<OutputHandle> OutputsOf(const std::string& system_type,
                                      const std::string& signal_type) const;
  const LoadedDiagram::Block* BlockOf(const System* system) const;

 private:
  using Key = std::pair<const System*, int>;
  struct Settled {
    std::string text;
    int rates;
  };

  void SettleUnits();
  bool SettleFrom(const System* system, const Unit& unit, const Settled& settled);
  std::optional<Settled> SettledOf(const System* system, const Unit& unit) const;
  void ClaimModels();
  void SpreadClaims();
  bool Claim(const System& system, const std::string& robot);
  std::vector<OutputHandle> VectorsAt(const System& system) const;

  const LoadedDiagram& loaded_;
  const Context& context_;
  std::map<const System*, const LoadedDiagram::Block*> blocks_;
  std::map<Key, OutputHandle> drivers_;
  std::map<Key, Settled> units_;  ///< by system and unit variable
  std::map<Key, std::string> robots_;
};

}  // namespace oca::diagrams
