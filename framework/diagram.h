// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "framework/context.h"
#include "framework/system.h"

namespace oca {

class Plan;

/// Systems and the connections between their ports; itself a System, so diagrams nest.
///
/// Made by DiagramBuilder. Nested diagrams are flattened when the root is built: nesting costs
/// nothing at run time. Only a root diagram makes Contexts.
class Diagram final : public System {
 public:
  struct Child {
    std::string name;
    std::unique_ptr<System> system;
  };
  struct Connection {
    OutputHandle from;
    InputHandle to;
  };
  struct ExportedInput {
    std::string name;
    std::vector<InputHandle> to;
    int size{-1};  ///< of a Vector; -1: as the systems behind it settle it
  };

  ~Diagram() override;

  /// A Context at time 0 with every state at its initial value.
  /// throws WiringError if this diagram is nested in another one.
  Context MakeContext() const;

  /// Typed ports by name. throw WiringError if there is no such port or its type differs.
  template <class T>
  Input<T> GetInput(const std::string& name) const {
    return {CheckedInput(name, TypeOf<T>())};
  }
  template <class T>
  Output<T> GetOutput(const std::string& name) const {
    return {CheckedOutput(name, TypeOf<T>())};
  }
  InputHandle FindInput(const std::string& name) const override;
  /// A handle on the port of the system inside.
  OutputHandle FindOutput(const std::string& name) const override;

  const std::vector<Child>& children() const { return children_; }
  const std::vector<Connection>& connections() const { return connections_; }
  const std::vector<ExportedInput>& exported_inputs() const { return exported_inputs_; }
  const std::vector<std::pair<std::string, OutputHandle>>& exported_outputs() const {
    return exported_outputs_;
  }
  /// The system at a dot-separated path; nullptr if there is none.
  const System* FindSystem(const std::string& path) const;
  /// throws WiringError if this diagram is nested in another one.
  const Plan& plan() const;

 private:
  friend class DiagramBuilder;
  friend class PlanCompiler;
  Diagram();

  InputHandle CheckedInput(const std::string& name, const SignalType& type) const;
  OutputHandle CheckedOutput(const std::string& name, const SignalType& type) const;

  std::vector<Child> children_;
  std::vector<Connection> connections_;
  std::vector<ExportedInput> exported_inputs_;
  std::vector<std::pair<std::string, OutputHandle>> exported_outputs_;
  std::unique_ptr<Plan> own_plan_;  // of a root
};

/// Collects systems and connections; Build checks all of it and compiles the plan.
class DiagramBuilder {
 public:
  DiagramBuilder();
  ~DiagramBuilder();

  /// Adds a system made from `arguments`. throws WiringError if the name is taken or not a name
  /// (letters, digits and underscores).
  template <class S, class... Arguments>
  const S& Add(std::string name, Arguments&&... arguments) {
    auto system = std::make_unique<S>(std::forward<Arguments>(arguments)...);
    const S& reference = *system;
    AddSystem(std::move(name), std::move(system));
    return reference;
  }
  const System& AddSystem(std::string name, std::unique_ptr<System> system);

  template <class T>
  void Connect(const Output<T>& from, const std::type_identity_t<Input<T>>& to) {
    ConnectPorts(from, to);
  }
  template <class T>
  void Connect(const Output<T>& from, const std::type_identity_t<OptionalInput<T>>& to) {
    ConnectPorts(from, to);
  }
  /// For wiring known only at run time; a difference in type is found at Build.
  void ConnectPorts(const OutputHandle& from, const InputHandle& to);
  /// Makes an input, or several that share a name, an input of the diagram.
  /// `size` settles the length of a Vector input that the systems leave open.
  void ExportInput(std::string name, const InputHandle& input, int size = -1);
  void ExportOutput(std::string name, const OutputHandle& output);

  /// The finished diagram; the builder is empty afterwards.
  /// throws WiringError with all problems: unconnected inputs, inputs with two drivers, unequal
  /// types, sizes or units, algebraic loops.
  std::unique_ptr<Diagram> Build();

 private:
  std::unique_ptr<Diagram> diagram_;
};

/// A root diagram of one system that exports its ports under their own names: all outputs, all
/// required inputs, and the inputs that `sizes` names (lengths of Vectors, -1: not said).
std::unique_ptr<Diagram> MakeDiagramOf(std::unique_ptr<System> system,
                                       const std::map<std::string, int>& sizes = {});

}  // namespace oca
