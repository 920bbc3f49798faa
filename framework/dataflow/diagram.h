// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error_base.h"
#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/framework/dataflow/upstream.h"

namespace oca {

class Schedule;
class Wiring;

/// Systems and the connections between their ports; itself a System, so diagrams nest.
///
/// Made by DiagramBuilder. Nested diagrams are flattened when the root is built: nesting costs
/// nothing at run time. Only a root diagram makes Contexts.
///
/// A path is dotted and goes through nesting: `arm.filter` is the system `filter` in the diagram
/// `arm`, `arm.filter.velocities` a port of it, and `velocities` alone a port of this diagram. An
/// input of a diagram may have the path of an output that drives it elsewhere, `plant.position`.
///
/// Whoever wants to know how it is wired asks it. The answers speak of leaves, the systems that
/// are no diagrams, whatever nesting lies between; a nested diagram answers through its root, which
/// must have been built. They throw WiringError if a port or a system is of another diagram.
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
  struct Leaf {
    std::string path;  ///< from the root
    const System* system;
  };

  ~Diagram() override;

  /// A Context at time 0 with every state at its initial value.
  /// throws WiringError if this diagram is nested in another one.
  Context MakeContext() const;

  /// Typed ports by path. throw WiringError if there is no such port or its type differs.
  template <class T>
  Input<T> GetInput(const std::string& path) const {
    return Typed<T>(FindInput(path), path);
  }
  template <class T>
  Output<T> GetOutput(const std::string& path) const {
    return Typed<T>(FindOutput(path), path);
  }
  /// Ports by path. throw WiringError naming what there is.
  InputHandle FindInput(const std::string& path) const override;
  /// A handle on the port of the leaf inside.
  OutputHandle FindOutput(const std::string& path) const override;
  /// The system at a path, leaf or diagram; nullptr if there is none.
  const System* FindSystem(const std::string& path) const;

  /// The leaves in this diagram, in order.
  std::vector<Leaf> systems() const;
  /// All that leaves in this diagram declare of a role, in order.
  template <class Role>
  struct Declared {
    std::string path;
    const System* system;
    const Role* role;
  };
  template <class Role>
  std::vector<Declared<Role>> FindRoles() const {
    std::vector<Declared<Role>> found;
    for (const Leaf& leaf : systems()) {
      for (const Role* role : leaf.system->template roles<Role>()) {
        found.push_back({leaf.path, leaf.system, role});
      }
    }
    return found;
  }
  /// From the root; of the root itself empty.
  std::string PathOf(const System& system) const;
  std::string PathOf(const OutputHandle& output) const;
  std::string PathOf(const InputHandle& input) const;
  /// The output that drives an input; none if nothing does or if it comes from outside.
  std::optional<OutputHandle> DriverOf(const InputHandle& input) const;
  /// What drives the inputs of a leaf, in their order; without those that nothing drives, or that
  /// come from outside.
  std::vector<Connection> DriversOf(const System& leaf) const;
  /// The input of the root through which an input comes from outside; none if it does not.
  std::optional<InputHandle> ExportOf(const InputHandle& input) const;
  /// The inputs of leaves that an output drives.
  std::vector<InputHandle> ReadersOf(const OutputHandle& output) const;
  /// All that a port depends on.
  Upstream UpstreamOf(const OutputHandle& output, Through through) const;
  Upstream UpstreamOf(const InputHandle& input, Through through) const;
  /// The leaves `from`, what drives their inputs, what drives those, and so on, each once; nothing
  /// that lies behind one that `ends` holds for, which is itself among them.
  std::vector<const System*> LeavesUpstream(std::vector<const System*> from,
                                            const std::function<bool(const System&)>& ends) const;
  /// The length of a Vector, as Build settled it; 0 for a port of another type.
  int SizeOf(const OutputHandle& output) const;
  int SizeOf(const InputHandle& input) const;
  /// The unit of a Vector, as Build settled it; any if nothing says it.
  Unit UnitOf(const OutputHandle& output) const;
  Unit UnitOf(const InputHandle& input) const;

  // As it was put together, without a look into nested diagrams.
  const std::vector<Child>& children() const { return children_; }
  const std::vector<Connection>& connections() const { return connections_; }
  const std::vector<ExportedInput>& exported_inputs() const { return exported_inputs_; }
  const std::vector<std::pair<std::string, OutputHandle>>& exported_outputs() const {
    return exported_outputs_;
  }
  /// throws WiringError if this diagram is nested in another one.
  const Schedule& schedule() const;

 private:
  friend class DiagramBuilder;
  friend class ScheduleCompiler;
  Diagram();

  /// The wiring of the root. throws WiringError unless that was built.
  const Wiring& wiring() const;
  /// The system that a port's path leads to, and what is left: the name of the port.
  std::pair<const System*, std::string> SplitPath(const std::string& path, const char* kind) const;
  /// To this diagram and those inside, before and after their root is built.
  void SetRoot(const Diagram* root);

  std::vector<Child> children_;
  std::vector<Connection> connections_;
  std::vector<ExportedInput> exported_inputs_;
  std::vector<std::pair<std::string, OutputHandle>> exported_outputs_;
  const Diagram* root_{nullptr};              // once that is built
  std::unique_ptr<const Wiring> own_wiring_;  // of a root
  std::unique_ptr<Schedule> own_schedule_;    // of a root
};

/// Collects systems and connections; Build checks all of it and compiles the schedule.
class DiagramBuilder {
 public:
  DiagramBuilder();
  ~DiagramBuilder();

  /// Adds a system made from `arguments`. throws WiringError if the name is taken or not a name
  /// (letters, digits and underscores), and what the constructor throws, with the name before it.
  template <class S, class... Arguments>
  const S& Add(std::string name, Arguments&&... arguments) {
    auto system = Make<S>(name, std::forward<Arguments>(arguments)...);
    const S& reference = *system;
    AddSystem(std::move(name), std::move(system));
    return reference;
  }
  /// The same with parameters in braces: Add<Gain>("gain", {.gain = 2.0}); `rest` is what the
  /// constructor takes beside them, say the models. throws ConfigError if the parameters are not
  /// what they are described to be: see Validated.
  template <class S, class... Rest>
  const S& Add(std::string name, const typename S::Params& params, Rest&&... rest) {
    if constexpr (ParamsStruct<typename S::Params>) Validated(params, name);
    auto system = Make<S>(name, params, std::forward<Rest>(rest)...);
    const S& reference = *system;
    AddSystem(std::move(name), std::move(system));
    return reference;
  }
  /// The same with all parameters at their defaults: Add<Integrator>("integrator").
  template <class S>
  requires(!std::default_initializable<S> && std::default_initializable<typename S::Params> &&
           std::constructible_from<S, const typename S::Params&>) const S& Add(std::string name) {
    return Add<S>(std::move(name), typename S::Params{});
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
  /// Makes an input, or several that share a name, an input of the diagram. The name may be a path,
  /// which then leads to no other port inside (Build finds it).
  /// `size` settles the length of a Vector input that the systems leave open.
  void ExportInput(std::string name, const InputHandle& input, int size = -1);
  void ExportOutput(std::string name, const OutputHandle& output);

  /// The finished diagram; the builder is empty afterwards.
  /// throws WiringError with all problems: unconnected inputs, inputs with two drivers, unequal
  /// types, sizes or units, algebraic loops.
  std::unique_ptr<Diagram> Build();
  /// The diagram as it was put together, to be added to another builder, whose Build finds all that
  /// is wrong in it. Inputs in it may be driven from there. The builder is empty afterwards.
  std::unique_ptr<Diagram> BuildInner();

 private:
  template <class S, class... Arguments>
  static std::unique_ptr<S> Make(const std::string& name, Arguments&&... arguments) {
    try {
      return std::make_unique<S>(std::forward<Arguments>(arguments)...);
    } catch (const Error&) {
      ThrowOfSystem(name);
    }
  }
  /// Throws the current exception, with the system's name before it.
  [[noreturn]] static void ThrowOfSystem(const std::string& name);

  std::unique_ptr<Diagram> diagram_;
};

/// A root diagram of one system that exports its ports under their own names: all outputs, all
/// required inputs, and the inputs that `sizes` names (lengths of Vectors, -1: not said).
std::unique_ptr<Diagram> MakeDiagramOf(std::unique_ptr<System> system,
                                       const std::map<std::string, int>& sizes = {});

}  // namespace oca
