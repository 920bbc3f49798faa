// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/profile.h"
#include "oca/framework/dataflow/system.h"

namespace oca {

/// A root diagram compiled into flat arrays; what the simulator and the port handles work on.
///
/// Everything that can change on its own is a *source*: the time, the continuous state, each
/// discrete state, each fixed input. A source carries the epoch of its last change. A *node* is
/// the calculation of an output or a cached value; it carries the epoch at which it was last
/// computed, and nodes with the same set of sources share one *source class*, whose newest change
/// is looked up once an epoch. A node is up to date when it was computed no earlier than its class
/// changed. Epoch 0 is before everything: a source still there is an exported input that nobody has
/// fixed.
class Schedule {
 public:
  struct Node {
    Calculation::Function function;
    const System* system;
    std::uint32_t first_slot;  ///< into slots
    std::uint32_t source_class;
    Slot out;
    const SignalType* type;              ///< nullptr: a cached value
    bool vector;                         ///< of type Vector
    int port;                            ///< output that a failure is told of; -1: none
    std::uint32_t pull_begin, pull_end;  ///< into pulls: nodes it needs and itself, in order
  };
  struct SourceClass {
    std::uint32_t begin, end;  ///< into class_sources
  };
  struct InputEntry {
    Slot slot;
    int source{-1};                           ///< of an exported input
    std::vector<const Plausible*> plausible;  ///< of an exported input: of all that it drives
  };
  /// A state that an input shows, which says what it can be.
  struct ShownState {
    const System* system;  ///< whose the output is
    int output;
    Slot slot;
    const Plausible* plausible;
    bool set_at_start;  ///< by an initialization event
  };
  struct OutputEntry {
    Slot slot;
    int node{-1};  ///< -1: a state or a fixed input, always up to date
  };
  struct StateEntry {
    Slot slot;
    Slot next;  ///< where updates write; for a continuous state the derivative lies elsewhere
    const SignalType* type;
    int source;
    bool continuous;
    bool in_derivatives;  ///< a derivative depends on it, so a change restarts the integrator
    const System::StateInfo* info;
  };
  struct Derivative {
    Calculation::Function function;
    const System* system;
    std::uint32_t first_slot;
    Slot out;
    std::string state;  ///< its name
  };
  struct Event {
    System::Stage stage;
    Calculation::Function function;
    const System* system;
    std::uint32_t first_slot;
    std::uint32_t pull_begin, pull_end;
    std::vector<int> writes;  ///< states
  };
  /// What a commit means for the integrator.
  enum class Change { kNone, kDerivative, kState };
  /// Events of one stage with the same period and offset.
  struct Group {
    System::Stage stage;
    Every every;
    std::vector<int> events;
  };
  struct Witness {
    Calculation::Function function;
    const System* system;
    std::uint32_t first_slot;
    std::uint32_t pull_begin, pull_end;
    std::string name;
    Direction direction;
    std::vector<int> events;  ///< resets that wait for it
  };
  /// What a Context keeps of a witness.
  struct WitnessState {
    double value;          ///< where the function writes
    double rest;           ///< no larger is still zero, since the last crossing
    double window_start;   ///< s; of the crossings that are counted
    double last;           ///< s; the last crossing
    double interval;       ///< s; between the last two
    std::int64_t row;      ///< crossings, each sooner after the one before
    std::int64_t count;    ///< crossings since window_start
    std::int64_t pending;  ///< crossed, and its resets have not run yet
  };
  struct Object {
    std::uint32_t offset;
    const ObjectType* type;
  };

  // Evaluation. `context` is const to callers; its cache is not.
  void Evaluate(const Context& context, int node) const {
    if (!UpToDate(context, node)) Pull(context, node);
  }
  bool UpToDate(const Context& context, int node) const {
    return node_states(context)[node].checked == context.header().epoch;
  }
  /// Brings the nodes in pulls[begin, end) up to date.
  void PullRange(const Context& context, std::uint32_t begin, std::uint32_t end) const;
  /// throws SimulationError naming an exported input that has no value yet.
  void CheckInputsFixed(const Context& context) const;
  /// throws SimulationError naming an output whose state starts where the inputs that read it say
  /// that nothing can be. Unless `initialized` what initialization events set does not count.
  void CheckStart(const Context& context, bool initialized) const;
  /// Derivatives of all continuous state at the context's time and state, into `derivatives`.
  void EvaluateDerivatives(Context& context, double* derivatives) const;
  /// Lets values that are no Vectors grow to what a tick needs, so that the first tick does not
  /// allocate: computes what updates read and runs those that write such states, whose values stay
  /// as they are. A calculation that fails is left to the tick that needs it.
  void TakeCapacity(Context& context) const;
  /// Runs one event; what it writes goes to the states' `next`.
  void RunEvent(Context& context, const Event& event) const;
  /// Makes `next` the state.
  Change Commit(Context& context, const Event& event) const;

  /// A witness function at the context's time and state.
  double EvaluateWitness(Context& context, int witness) const;

  /// What an integrator does before it asks for derivatives.
  void SetTimeAndState(Context& context, double time, const double* state) const;
  double& integrator_step(Context& context) const { return context.header().integrator_step; }

  void MarkChanged(Context& context, int source) const {
    // A jump of the state makes the step that the integrator would try next worthless.
    if (source == kContinuousSource) context.header().integrator_step = 0.0;
    versions(context)[source] = ++context.header().epoch;
  }
  /// The schedule of a handle of an input, output, cached value or state. Throws WiringError if the
  /// context is of another diagram.
  template <class H>
  static const Schedule& Of(const H& handle, const Context& context) {
    const Schedule* const schedule = handle.system == nullptr ? nullptr : handle.system->schedule_;
    if (schedule == nullptr || schedule != context.schedule_) RefuseForeign(handle);
    return *schedule;
  }

  std::byte* arena(const Context& context) const { return context.arena_.get(); }
  std::uint64_t* versions(const Context& context) const {
    return reinterpret_cast<std::uint64_t*>(arena(context) + versions_offset);
  }
  double* continuous(const Context& context) const {
    return reinterpret_cast<double*>(arena(context) + continuous_offset);
  }
  std::int64_t* group_counts(const Context& context) const {
    return reinterpret_cast<std::int64_t*>(arena(context) + counts_offset);
  }
  WitnessState* witness_states(const Context& context) const {
    return reinterpret_cast<WitnessState*>(arena(context) + witnesses_offset);
  }
  std::string PathOf(const System& system) const;
  const InputEntry& input(const InputHandle& handle) const;
  /// Whether an input is one of this diagram, and from outside.
  bool Imports(const InputHandle& handle) const noexcept {
    const System* const system = handle.system;
    return system != nullptr && system->schedule_ == this && input(handle).source >= 0;
  }
  const OutputEntry& output(const OutputHandle& handle) const {
    return outputs[handle.system->first_output_ + handle.index];
  }
  /// The node of a cached value.
  int cached(const CachedHandle& handle) const {
    return cached_nodes[handle.system->first_cached_ + handle.index];
  }
  const StateEntry& state(const StateHandle& handle) const {
    return states[handle.system->first_state_ + handle.index];
  }

  static constexpr int kTimeSource = 0;
  static constexpr int kContinuousSource = 1;

  std::vector<Node> nodes;  ///< in evaluation order
  std::vector<std::uint32_t> pulls;
  std::vector<Slot> slots;
  std::vector<SourceClass> classes;
  std::vector<std::uint32_t> class_sources;
  std::vector<InputEntry> inputs;           ///< of all leaf systems
  std::vector<InputEntry> exported_inputs;  ///< of the root
  std::vector<ShownState> shown_states;
  std::vector<OutputEntry> outputs;  ///< of all leaf systems
  std::vector<int> cached_nodes;     ///< of all leaf systems
  std::vector<StateEntry> states;    ///< of all leaf systems
  std::vector<Derivative> derivatives;
  std::uint32_t derivative_pull_begin{0}, derivative_pull_end{0};
  std::vector<Event> events;
  std::vector<Group> groups;
  std::vector<Witness> witnesses;
  std::vector<int> initializations;  ///< events
  std::vector<Object> objects;
  std::vector<std::string> source_names;
  std::vector<const System*> systems;  ///< leaves
  std::vector<std::string> paths;      ///< of the leaves
  const System* root{nullptr};

  int continuous_size{0};
  std::uint32_t versions_offset{0}, class_states_offset{0}, node_states_offset{0};
  std::uint32_t counts_offset{0}, continuous_offset{0}, derivative_offset{0};
  std::uint32_t witnesses_offset{0};
  std::uint32_t plain_size{0};  ///< bytes that memcpy may copy
  std::uint32_t arena_size{0};

 private:
  struct NodeState {
    std::uint64_t computed;
    std::uint64_t checked;
  };
  struct ClassState {
    std::uint64_t changed;
    std::uint64_t checked;
  };

  NodeState* node_states(const Context& context) const {
    return reinterpret_cast<NodeState*>(arena(context) + node_states_offset);
  }
  /// Calls a calculation, on account of its system if there is a profile.
  void Call(Calculation::Function function, const System& system, std::byte* memory,
            std::uint32_t first_slot, Profile* profile) const {
    if (profile == nullptr) return function(system, memory, &slots[first_slot]);
    profile->Time(system.leaf_, [&] { function(system, memory, &slots[first_slot]); });
  }
  std::uint64_t ClassChanged(const Context& context, std::uint32_t source_class) const;
  void Pull(const Context& context, int node) const;
  [[noreturn]] void Fail(const Context& context, const System* system, const std::string& port,
                         const char* what) const;
  /// By what a calculation threw, whatever its type; a SimulationError goes on as it is.
  [[noreturn]] void FailByException(const Context& context, const System* system,
                                    const std::string& port) const;
  void FailUnfixed(const Context& context, std::uint32_t source) const;
  [[noreturn]] void FailNode(const Context& context, std::uint32_t node) const;
  [[noreturn]] void FailState(const Context& context, const Event& event,
                              const StateEntry& state) const;
  void FailDerivative(const Context& context) const;
  void GrowLikeNext(Context& context, const StateEntry& state) const;
  template <class H>
  [[noreturn]] static void RefuseForeign(const H& handle);
  /// The name of the port that a node's failure is told of.
  std::string PortOf(const Node& node) const;
};

}  // namespace oca
