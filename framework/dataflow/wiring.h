// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"

namespace oca {

/// A diagram with its nesting resolved: leaf systems, what drives each of their inputs, and the
/// settled length and unit of every vector. All wiring problems are collected, none throws. The
/// root keeps it, to answer by.
class Wiring {
 public:
  /// What an input reads: an output of a leaf, an input that the root exports, or nothing.
  struct Driver {
    int leaf{-1};
    int output{-1};
    int exported{-1};
    bool none() const { return leaf < 0 && exported < 0; }
  };
  struct Leaf {
    System* system;
    std::string path;
    std::vector<Driver> drivers;  ///< one an input
    std::vector<int> sizes;       ///< of the size variables
    std::vector<Unit> units;      ///< of the unit variables; any: nothing settles it
  };

  explicit Wiring(const Diagram& root);

  const Diagram& root() const { return root_; }
  const std::vector<Leaf>& leaves() const { return leaves_; }
  std::vector<Leaf>& leaves() { return leaves_; }
  /// The number of the leaf that a port is of; throws WiringError if it is of none.
  int LeafOf(const OutputHandle& output) const;
  /// Length of a vector port or state of a leaf.
  int SizeOf(int leaf, const Size& size) const;
  /// Unit of a port or state of a leaf.
  Unit UnitOf(int leaf, const Unit& unit) const;
  /// An input of a leaf.
  struct Target {
    int leaf;
    int input;
  };
  /// The leaf inputs behind an input of a leaf or of a diagram, the first of which settles its type
  /// and length; none: of no system inside.
  std::vector<Target> TargetsOf(const InputHandle& input) const;
  const System::InputInfo& InfoOf(const Target& target) const;
  const std::vector<std::vector<Target>>& exported() const { return exported_; }
  /// The dotted path of a leaf or a nested diagram, empty of the root; throws WiringError if it is
  /// not inside.
  std::string PathOf(const System& system) const;
  bool Contains(const System& system) const {
    return index_.contains(&system) || diagram_paths_.contains(&system);
  }
  std::vector<WiringProblem>& problems() { return problems_; }

  PortPath PathOfInput(int leaf, int input) const;
  PortPath PathOfOutput(int leaf, int output) const;

 private:
  void Flatten(const Diagram& diagram, const std::string& prefix);
  void ConnectAll(const Diagram& diagram, const std::string& prefix);
  void Connect(const Diagram::Connection& connection, const std::string& prefix);
  void ExportAll(const Diagram& root);
  void CheckPathOf(const Diagram::ExportedInput& exported);
  void CheckExportedOutputs();
  void Drive(const Target& target, const Driver& driver);
  void CheckUnconnected();
  void SettleSizes();
  void SettleUnits();
  void CheckInitialValues();

  /// What drives an input is wrong.
  void AddProblem(const Target& target, std::vector<WiringProblem::Part> text);
  WiringProblem::Part NameOfDriver(const Driver& driver) const;
  /// Ends of a connection: by their paths, if they are inside.
  WiringProblem::Part NameOfEnd(const OutputHandle& output) const;
  WiringProblem::Part NameOfEnd(const InputHandle& input) const;

  const Diagram& root_;
  std::vector<Leaf> leaves_;
  std::map<const System*, int> index_;
  std::map<const System*, std::string> diagram_paths_;
  std::vector<std::vector<Target>> exported_;
  std::vector<WiringProblem> problems_;
};

}  // namespace oca
