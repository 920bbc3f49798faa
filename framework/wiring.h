// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/diagram.h"

namespace oca {

/// A diagram with its nesting resolved: leaf systems, what drives each of their inputs, and the
/// settled length of every vector. All wiring problems are collected, none throws.
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
  };

  explicit Wiring(const Diagram& root);

  const std::vector<Leaf>& leaves() const { return leaves_; }
  std::vector<Leaf>& leaves() { return leaves_; }
  /// Length of a vector port or state of a leaf.
  int SizeOf(int leaf, const Size& size) const;
  /// The leaf input that settles the type and length of an exported input.
  struct Target {
    int leaf;
    int input;
  };
  const std::vector<std::vector<Target>>& exported() const { return exported_; }
  std::vector<std::string>& problems() { return problems_; }

  std::string NameOfInput(int leaf, int input) const;
  std::string NameOfOutput(int leaf, int output) const;

 private:
  void Flatten(const Diagram& diagram, const std::string& prefix);
  void ConnectAll(const Diagram& diagram, const std::string& prefix);
  void Connect(const Diagram::Connection& connection, const std::string& prefix);
  void ExportAll(const Diagram& root);
  void CheckExportedOutputs();
  void Drive(const Target& target, const Driver& driver);
  void CheckUnconnected();
  void SettleSizes();
  void SettleUnits();
  void CheckInitialValues();

  /// The leaf inputs behind an input of a leaf or of a nested diagram.
  std::vector<Target> TargetsOf(const InputHandle& input) const;
  std::string NameOfDriver(const Driver& driver) const;
  const System::InputInfo& InfoOf(const Target& target) const;

  const Diagram& root_;
  std::vector<Leaf> leaves_;
  std::map<const System*, int> index_;
  std::map<const System*, std::string> diagram_paths_;
  std::vector<std::vector<Target>> exported_;
  std::vector<std::string> problems_;
};

}  // namespace oca
