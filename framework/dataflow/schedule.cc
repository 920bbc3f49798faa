// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/log.h"
#include "oca/framework/dataflow/port_name.h"

namespace oca {

std::uint64_t Schedule::ClassChanged(const Context& context, std::uint32_t source_class) const {
  auto& state = reinterpret_cast<ClassState*>(arena(context) + class_states_offset)[source_class];
  if (state.checked != context.header().epoch) {
    const std::uint64_t* version = versions(context);
    std::uint64_t newest = 1;  // what reads nothing is computed once
    for (std::uint32_t i = classes[source_class].begin; i < classes[source_class].end; ++i) {
      if (version[class_sources[i]] == 0) FailUnfixed(context, class_sources[i]);
      newest = std::max(newest, version[class_sources[i]]);
    }
    state = {newest, context.header().epoch};
  }
  return state.changed;
}

void Schedule::Pull(const Context& context, int node) const {
  NodeState& state = node_states(context)[node];
  const Node& target = nodes[node];
  // What the target needs depends on no more sources than the target itself.
  if (state.computed >= ClassChanged(context, target.source_class)) {
    state.checked = context.header().epoch;
    return;
  }
  PullRange(context, target.pull_begin, target.pull_end);
}

void Schedule::PullRange(const Context& context, std::uint32_t begin, std::uint32_t end) const {
  NodeState* const states_of_nodes = node_states(context);
  std::byte* const memory = arena(context);
  const std::uint64_t epoch = context.header().epoch;
  Profile* const profile = context.header().profile;
  constexpr std::uint32_t kNoClass = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t last_class = kNoClass;  // neighbours mostly share their class
  std::uint64_t changed = 0;
  std::uint32_t index = 0;
  try {
    for (std::uint32_t i = begin; i < end; ++i) {
      index = pulls[i];
      NodeState& state = states_of_nodes[index];
      if (state.checked == epoch) continue;
      const Node& node = nodes[index];
      if (node.source_class != last_class) {
        last_class = node.source_class;
        changed = ClassChanged(context, last_class);
      }
      if (state.computed < changed) {
        Call(node.function, *node.system, memory, node.first_slot, profile);
        const std::byte* const value = memory + node.out.offset;
        const bool finite =
            node.vector ? AllFinite(reinterpret_cast<const double*>(value), node.out.size)
                        : node.type == nullptr || node.type->check(value, Look::kFinite).ok();
        if (!finite) FailNode(context, index);
        state.computed = epoch;
      }
      state.checked = epoch;
    }
  } catch (...) {
    FailByException(context, nodes[index].system, PortOf(nodes[index]));
  }
}

std::string Schedule::PortOf(const Node& node) const {
  return node.port < 0 ? "" : node.system->outputs()[node.port].name;
}

void Schedule::FailNode(const Context& context, std::uint32_t index) const {
  const Node& node = nodes[index];
  const std::string port = PortOf(node);
  if (node.vector) {
    Fail(context, node.system, port, "the value is not finite (NaN or infinity)");
  }
  const Fault fault = node.type->check(arena(context) + node.out.offset, Look::kFinite);
  Fail(context, node.system, port, fmt::format("the value: {}", fault.text()).c_str());
}

void Schedule::FailUnfixed(const Context& context, std::uint32_t source) const {
  for (const System* const system : systems) {
    for (std::size_t i = 0; i < system->inputs().size(); ++i) {
      if (inputs[system->first_input_ + i].source != static_cast<int>(source)) continue;
      Fail(context, system, system->inputs()[i].name, "the exported input has not been fixed");
    }
  }
}

void Schedule::CheckInputsFixed(const Context& context) const {
  for (const InputEntry& input : exported_inputs) {
    if (versions(context)[input.source] == 0) FailUnfixed(context, input.source);
  }
}

void Schedule::Fail(const Context& context, const System* system, const std::string& port,
                    const char* what) const {
  throw SimulationError(PathOf(*system), port, context.time(), what);
}

void Schedule::FailByException(const Context& context, const System* system,
                               const std::string& port) const {
  try {
    throw;
  } catch (const SimulationError&) {
    throw;
  } catch (const std::exception& error) {
    Fail(context, system, port, internal::Explain(error).c_str());
  } catch (...) {
    Fail(context, system, port, "an exception of an unknown type");
  }
}

void Schedule::CheckStart(const Context& context, bool initialized) const {
  for (const ShownState& shown : shown_states) {
    if (shown.set_at_start && !initialized) continue;
    const auto* values = reinterpret_cast<const double*>(arena(context) + shown.slot.offset);
    const Fault fault = shown.plausible->Check(values);
    if (fault.ok()) continue;
    Fail(context, shown.system, shown.system->outputs()[shown.output].name, fault.text());
  }
}

std::string Schedule::PathOf(const System& system) const {
  const auto found = std::find(systems.begin(), systems.end(), &system);
  return found == systems.end() ? "diagram" : paths[found - systems.begin()];
}

void Schedule::EvaluateDerivatives(Context& context, double* result) const {
  if (derivative_pull_begin != derivative_pull_end) {
    PullRange(context, derivative_pull_begin, derivative_pull_end);
  }
  for (const Derivative& derivative : derivatives) {
    try {
      Call(derivative.function, *derivative.system, arena(context), derivative.first_slot,
           context.header().profile);
    } catch (...) {
      FailByException(context, derivative.system, derivative.state);
    }
  }
  const auto* computed = reinterpret_cast<const double*>(arena(context) + derivative_offset);
  if (!AllFinite(computed, static_cast<std::size_t>(continuous_size))) FailDerivative(context);
  std::memcpy(result, computed, sizeof(double) * static_cast<std::size_t>(continuous_size));
}

void Schedule::FailDerivative(const Context& context) const {
  for (const Derivative& derivative : derivatives) {
    const auto* values = reinterpret_cast<const double*>(arena(context) + derivative.out.offset);
    if (!AllFinite(values, derivative.out.size)) {
      Fail(context, derivative.system, derivative.state,
           "the derivative is not finite (NaN or infinity)");
    }
  }
}

void Schedule::RunEvent(Context& context, const Event& event) const {
  PullRange(context, event.pull_begin, event.pull_end);
  std::byte* const memory = arena(context);
  for (const int index : event.writes) {
    const StateEntry& state = states[index];
    if (state.type == &kVectorType) {
      std::memcpy(memory + state.next.offset, memory + state.slot.offset,
                  sizeof(double) * state.slot.size);
    } else {
      state.type->assign(memory + state.next.offset, memory + state.slot.offset);
    }
  }
  try {
    Call(event.function, *event.system, memory, event.first_slot, context.header().profile);
  } catch (...) {
    FailByException(context, event.system, "");
  }
  for (const int index : event.writes) {
    const StateEntry& state = states[index];
    const bool finite = state.type == &kVectorType
                            ? AllFinite(reinterpret_cast<const double*>(memory + state.next.offset),
                                        state.next.size)
                            : state.type->check(memory + state.next.offset, Look::kFinite).ok();
    if (!finite) FailState(context, event, state);
  }
}

void Schedule::FailState(const Context& context, const Event& event,
                         const StateEntry& state) const {
  const char* const what = "the new state is not finite (NaN or infinity)";
  if (state.type == &kVectorType) Fail(context, event.system, state.info->name, what);
  const Fault fault = state.type->check(arena(context) + state.next.offset, Look::kFinite);
  Fail(context, event.system, state.info->name,
       fmt::format("the new state: {}", fault.text()).c_str());
}

double Schedule::EvaluateWitness(Context& context, int index) const {
  const Witness& witness = witnesses[index];
  PullRange(context, witness.pull_begin, witness.pull_end);
  try {
    Call(witness.function, *witness.system, arena(context), witness.first_slot,
         context.header().profile);
  } catch (...) {
    FailByException(context, witness.system, witness.name);
  }
  const double value = witness_states(context)[index].value;
  if (!std::isfinite(value)) {
    Fail(context, witness.system, witness.name,
         "the witness function is not finite (NaN or infinity)");
  }
  return value;
}

Schedule::Change Schedule::Commit(Context& context, const Event& event) const {
  Change change = Change::kNone;
  std::byte* const memory = arena(context);
  for (const int index : event.writes) {
    const StateEntry& state = states[index];
    // Whether the integrator starts afresh must not hang on the value: a run that is resumed here
    // starts afresh in any case and has to give the same bits.
    if (state.continuous) {
      change = Change::kState;
    } else if (state.in_derivatives && change == Change::kNone) {
      change = Change::kDerivative;
    }
    if (state.type == &kVectorType) {
      const std::size_t bytes = sizeof(double) * state.slot.size;
      if (std::memcmp(memory + state.slot.offset, memory + state.next.offset, bytes) == 0) continue;
      std::memcpy(memory + state.slot.offset, memory + state.next.offset, bytes);
    } else {
      state.type->assign(memory + state.slot.offset, memory + state.next.offset);
    }
    MarkChanged(context, state.source);
  }
  return change;
}

void Schedule::SetTimeAndState(Context& context, double time, const double* state) const {
  if (state != continuous(context)) {
    std::memcpy(continuous(context), state,
                sizeof(double) * static_cast<std::size_t>(continuous_size));
  }
  Context::Header& header = context.header();
  header.time = time;
  versions(context)[kTimeSource] = versions(context)[kContinuousSource] = ++header.epoch;
}

void Schedule::TakeCapacity(Context& context) const {
  // A trial: what it would tell the first tick tells.
  struct Silence {
    explicit Silence(Context& context)
        : header(context.header()), log(std::exchange(header.log, &SilentLog())) {}
    ~Silence() { header.log = log; }
    Context::Header& header;
    Log* log;
  } silence(context);
  for (const Event& event : events) {
    if (event.stage != System::Stage::kUpdate && event.stage != System::Stage::kReset) continue;
    const bool writes_objects = std::any_of(event.writes.begin(), event.writes.end(),
                                            [&](int i) { return states[i].type != &kVectorType; });
    try {
      PullRange(context, event.pull_begin, event.pull_end);
      if (writes_objects) RunEvent(context, event);
    } catch (const SimulationError&) {
      continue;
    }
    for (const int index : event.writes) {
      if (states[index].type != &kVectorType) GrowLikeNext(context, states[index]);
    }
  }
}

void Schedule::GrowLikeNext(Context& context, const StateEntry& state) const {
  const SignalType& type = *state.type;
  std::byte* const at = arena(context) + state.slot.offset;
  const std::unique_ptr<std::byte, void (*)(std::byte*)> memory(
      static_cast<std::byte*>(operator new(type.size, std::align_val_t(64))),
      [](std::byte* bytes) { operator delete(bytes, std::align_val_t(64)); });
  type.construct(memory.get());
  type.assign(memory.get(), at);
  type.assign(at, arena(context) + state.next.offset);
  type.assign(at, memory.get());
  type.destroy(memory.get());
}

const Schedule::InputEntry& Schedule::input(const InputHandle& handle) const {
  if (handle.system == root) return exported_inputs[handle.index];
  return inputs[handle.system->first_input_ + handle.index];
}

template <class H>
void Schedule::RefuseForeign(const H& handle) {
  throw WiringError(internal::ForeignText(handle, "the diagram that made the context"));
}

template void Schedule::RefuseForeign(const InputHandle& handle);
template void Schedule::RefuseForeign(const OutputHandle& handle);
template void Schedule::RefuseForeign(const CachedHandle& handle);
template void Schedule::RefuseForeign(const StateHandle& handle);

}  // namespace oca
