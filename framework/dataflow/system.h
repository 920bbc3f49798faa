// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <any>
#include <concepts>
#include <functional>
#include <initializer_list>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/calculation.h"
#include "oca/framework/dataflow/per_component.h"
#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/port.h"

namespace oca {

class Schedule;

/// A discrete event that repeats: at offset, offset + period, offset + 2 period, ...
struct Every {
  Period period{};
  Period offset{};
};

/// The states that an update writes. Discrete states only, except in a reset.
template <class... States>
struct Writes {
  explicit constexpr Writes(const States&... written) : states(written...) {}
  std::tuple<States...> states;
};

/// What `simulator describe` says of a system type; every type in the catalogue has one as `kDoc`.
struct SystemDoc {
  const char* summary;   ///< one line
  const char* equation;  ///< recurrence or formula, in the names of ports and parameters
  const char* source;    ///< paper and equation; empty for the obvious
};

/// An immutable block of a diagram: typed ports, state, and the calculations between them.
///
/// A derived class declares everything in its constructor. Each calculation is a const member
/// function that receives exactly the inputs, states and time it was declared with, in that
/// order, then what it writes. What an output depends on is therefore known, never stated by hand,
/// and direct feedthrough, caching and algebraic loops follow from it.
///
///     out_(DeclareOutput<Vector, &Gain::CalcOut>("out", {n, unit}, in))
///     void CalcOut(VectorView in, MutableVectorView out) const { out = gain_ * in; }
///
/// All mutable values live in a Context. Systems are neither copied nor moved.
class System {
 public:
  struct InputInfo {
    std::string name;
    const SignalType* type;
    PortSpec spec;
    bool optional;
  };
  struct OutputInfo {
    std::string name;
    const SignalType* type;
    PortSpec spec;
    Calculation calculation;  ///< unused if `state` is set
    int state{-1};            ///< the output shows this state as it is
  };
  struct CachedInfo {
    const ObjectType* type;
    Calculation calculation;
  };
  struct StateInfo {
    std::string name;
    const SignalType* type;
    PortSpec spec;
    bool continuous{false};
    PerComponent initial{};                      ///< of a vector
    std::function<void(void*)> initial_value{};  ///< of another type; writes a constructed value
    Calculation derivative{};                    ///< of a continuous state
  };
  enum class Stage { kInitialization, kReset, kUpdate, kPublish };
  struct EventInfo {
    Stage stage;
    Every every;  ///< without meaning for an initialization
    Calculation calculation;
    std::vector<int> writes;  ///< states
    int witness{-1};          ///< that a reset waits for, instead of `every`
  };
  struct WitnessInfo {
    std::string name;
    Direction direction;
    Calculation calculation;
  };

  virtual ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  const std::vector<InputInfo>& inputs() const { return inputs_; }
  const std::vector<OutputInfo>& outputs() const { return outputs_; }
  const std::vector<CachedInfo>& cached() const { return cached_; }
  const std::vector<StateInfo>& states() const { return states_; }
  const std::vector<EventInfo>& events() const { return events_; }
  const std::vector<WitnessInfo>& witnesses() const { return witnesses_; }
  int size_variables() const { return size_variables_; }
  int unit_variables() const { return unit_variables_; }

  /// What the system is for others, beyond its ports: a role is a struct of any type that a
  /// constructor declares. nullptr if it has none of that type; the first of several.
  template <class Role>
  const Role* role() const {
    for (const std::any& declared : roles_) {
      if (const auto* const found = std::any_cast<Role>(&declared)) return found;
    }
    return nullptr;
  }
  /// All of a type, in the order of their declaration.
  template <class Role>
  std::vector<const Role*> roles() const {
    std::vector<const Role*> found;
    for (const std::any& declared : roles_) {
      if (const auto* const one = std::any_cast<Role>(&declared)) found.push_back(one);
    }
    return found;
  }

  /// Ports by name. throw WiringError naming the ports there are.
  virtual InputHandle FindInput(const std::string& name) const;
  virtual OutputHandle FindOutput(const std::string& name) const;

 protected:
  System() = default;

  Size DeclareSize() { return Size::Variable(size_variables_++); }
  /// The common length of per-component parameters; a variable if all are scalars.
  /// throws ConfigError if two lists differ in length.
  Size DeclareSize(std::initializer_list<std::pair<const char*, const PerComponent*>> parameters);
  Unit DeclareUnit() { return Unit::Variable(unit_variables_++); }

  template <class Role>
  void DeclareRole(Role role) {
    roles_.emplace_back(std::move(role));
  }

  template <class T>
  Input<T> DeclareInput(std::string name, PortSpec spec = {}) {
    static_assert(Taken<T>, "what an input takes has a Signal<T>::ReadJson");
    return Input<T>(AddInput({std::move(name), &TypeOf<T>(), std::move(spec), false}));
  }
  template <class T>
  OptionalInput<T> DeclareOptionalInput(std::string name, PortSpec spec = {}) {
    static_assert(Taken<T>, "what an input takes has a Signal<T>::ReadJson");
    return OptionalInput<T>(AddInput({std::move(name), &TypeOf<T>(), std::move(spec), true}));
  }

  /// A value that `kMethod(reads..., T& value)` computes for other calculations of this system,
  /// each time in place of the last one, so that T may hold the memory that its computation takes.
  /// A Context keeps and copies it as it does outputs. Its numbers are not looked at: what outputs
  /// and states take over of them is. A failure is told of the first output that reads it, or of
  /// the system if none does.
  template <auto kMethod, class... Reads>
  auto DeclareCached(const Reads&... reads) {
    using T = typename internal::LastOf<decltype(kMethod)>::Type;
    static_assert(std::semiregular<T>,
                  "a Context makes the value and assigns it when it is copied");
    static constexpr ObjectType kType = ObjectTypeOf<T>();
    return Cached<T>(AddCached({&kType, MakeCalculation<kMethod, WriteOf<T>>(reads...)}));
  }

  /// An output that `kMethod(reads..., T& out)` computes; or, with a data member as kMethod, that
  /// shows this member of the one cached value, state or signal that it reads.
  template <class T, auto kMethod, class... Reads>
  Output<T> DeclareOutput(std::string name, PortSpec spec, const Reads&... reads) {
    static_assert(Shown<T>, "what an output shows has a Signal<T>::WriteJson");
    auto calculation = MakeCalculation<kMethod, WriteOf<T>>(reads...);
    return Output<T>(
        AddOutput({std::move(name), &TypeOf<T>(), std::move(spec), std::move(calculation)}));
  }
  /// An output that shows a state; it costs nothing and breaks algebraic loops.
  template <class T>
  Output<T> DeclareStateOutput(std::string name, const DiscreteState<T>& state) {
    static_assert(Shown<T>, "what an output shows has a Signal<T>::WriteJson");
    return Output<T>(AddStateOutput(std::move(name), state));
  }
  Output<Vector> DeclareStateOutput(std::string name, const ContinuousState& state) {
    return Output<Vector>(AddStateOutput(std::move(name), state));
  }

  /// A vector state, `initial` at the start; a scalar `initial` counts for every component.
  DiscreteState<Vector> DeclareDiscreteState(std::string name, PortSpec spec,
                                             PerComponent initial) {
    return DiscreteState<Vector>(
        AddState({std::move(name), &kVectorType, std::move(spec), false, std::move(initial)}));
  }
  /// A state of another copyable type with a Signal trait.
  template <class T>
  DiscreteState<T> DeclareDiscreteState(std::string name, T initial) {
    return DiscreteState<T>(
        AddState({std::move(name), &TypeOf<T>(), {}, false, {}, [initial](void* at) {
                    *static_cast<T*>(at) = initial;
                  }}));
  }
  /// A state that DeclareDerivative's `kMethod(reads..., MutableVectorView derivative)` drives.
  ContinuousState DeclareContinuousState(std::string name, PortSpec spec, PerComponent initial) {
    return ContinuousState(
        AddState({std::move(name), &kVectorType, std::move(spec), true, std::move(initial)}));
  }
  template <auto kMethod, class... Reads>
  void DeclareDerivative(const ContinuousState& state, const Reads&... reads) {
    SetDerivative(state, MakeCalculation<kMethod, WriteOf<Vector>>(reads...));
  }

  /// Discrete update: `kMethod(reads..., next states...)`. The next states arrive holding the
  /// current ones; all updates of one instant read the same state and are applied together.
  template <auto kMethod, class... States, class... Reads>
  void DeclareUpdate(Every every, const Writes<States...>& writes, const Reads&... reads) {
    DeclareEvent<kMethod>(Stage::kUpdate, every, writes, reads...);
  }
  /// As an update, but it happens before the discrete updates of its instant and may write
  /// continuous states too; the integrator then starts afresh.
  template <auto kMethod, class... States, class... Reads>
  void DeclareReset(Every every, const Writes<States...>& writes, const Reads&... reads) {
    DeclareEvent<kMethod>(Stage::kReset, every, writes, reads...);
  }
  /// A witness function `double kMethod(reads...)`, continuous between events. A simulator ends a
  /// step where it, having been nonzero, reaches or crosses zero. A jump across zero that an
  /// update makes is no crossing: after an update the function is looked at afresh.
  template <auto kMethod, class... Reads>
  Witness DeclareWitness(std::string name, Direction direction, const Reads&... reads) {
    return AddWitness({std::move(name), direction, MakeWitness<kMethod>(reads...)});
  }
  /// A reset at each crossing of a witness function, in the first stage of the step that begins
  /// there. Resets of several witnesses may write one state; if their crossings coincide, what was
  /// declared last counts.
  template <auto kMethod, class... States, class... Reads>
  void DeclareReset(When when, const Writes<States...>& writes, const Reads&... reads) {
    AddEvent({Stage::kReset,
              {},
              MakeEvent<kMethod>(writes, reads...),
              WrittenBy(writes),
              WitnessIndex(when.witness)});
  }
  /// Happens once, when a simulator initializes.
  template <auto kMethod, class... States, class... Reads>
  void DeclareInitialization(const Writes<States...>& writes, const Reads&... reads) {
    DeclareEvent<kMethod>(Stage::kInitialization, {}, writes, reads...);
  }
  /// `kMethod(reads...)`, after the integrator has reached the instant; sees the state, changes
  /// nothing.
  template <auto kMethod, class... Reads>
  void DeclarePublish(Every every, const Reads&... reads) {
    DeclareEvent<kMethod>(Stage::kPublish, every, Writes<>(), reads...);
  }

  // What the templates above are made of, for systems whose ports and calculations are known only
  // at run time. Those that read what another system declared throw WiringError, as does an input
  // or an output of a type without JSON to read or to write.
  InputHandle AddInput(InputInfo info);
  OutputHandle AddOutput(OutputInfo info);
  OutputHandle AddStateOutput(std::string name, const StateHandle& state);
  CachedHandle AddCached(CachedInfo info);
  StateHandle AddState(StateInfo info);
  void SetDerivative(const StateHandle& state, Calculation calculation);
  Witness AddWitness(WitnessInfo info);
  void AddEvent(EventInfo info);

 private:
  friend class DiagramBuilder;
  friend class ScheduleCompiler;
  friend class Schedule;

  template <auto kMethod, class... States, class... Reads>
  void DeclareEvent(Stage stage, Every every, const Writes<States...>& writes,
                    const Reads&... reads) {
    AddEvent({stage, every, MakeEvent<kMethod>(writes, reads...), WrittenBy(writes)});
  }
  template <auto kMethod, class... States, class... Reads>
  static Calculation MakeEvent(const Writes<States...>& /*writes*/, const Reads&... reads) {
    return MakeCalculation<kMethod, WriteOf<typename SignalOf<States>::Type>...>(reads...);
  }
  template <class... States>
  std::vector<int> WrittenBy(const Writes<States...>& writes) const {
    return std::apply(
        [this](const auto&... state) { return std::vector<int>{StateIndex(state)...}; },
        writes.states);
  }
  /// throws WiringError if another system declared the state.
  int StateIndex(const StateHandle& state) const;
  /// throws WiringError if another system declared the witness.
  int WitnessIndex(const Witness& witness) const;
  /// throws WiringError if the calculation of `what` reads a port or a state that this system has
  /// not declared: its index would lead to another one.
  void CheckReads(const std::string& what, const Calculation& calculation) const;

  std::vector<InputInfo> inputs_;
  std::vector<OutputInfo> outputs_;
  std::vector<CachedInfo> cached_;
  std::vector<StateInfo> states_;
  std::vector<EventInfo> events_;
  std::vector<WitnessInfo> witnesses_;
  std::vector<std::any> roles_;
  int size_variables_{0};
  int unit_variables_{0};

  // Written when a root diagram is built: where its schedule keeps this system.
  const Schedule* schedule_{nullptr};
  int first_input_{0};
  int first_output_{0};
  int first_cached_{0};
  int first_state_{0};
  int leaf_{0};
};

}  // namespace oca
