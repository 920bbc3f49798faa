// SPDX-License-Identifier: BSD-3-Clause
// What each calculation finds where, and what must be computed before it.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <utility>

#include "oca/framework/dataflow/schedule_compiler.h"

namespace oca {
namespace {

void AddOnce(std::vector<const Plausible*>& all, const Plausible* one) {
  const auto same = [&](const Plausible* other) { return *other == *one; };
  if (std::none_of(all.begin(), all.end(), same)) all.push_back(one);
}

}  // namespace

Slot ScheduleCompiler::SlotOf(int leaf, const Read& read) const {
  const auto& leaves = wiring_.leaves();
  const auto state_slot = [&](int of_leaf, int state) {
    return schedule_->states[leaves[of_leaf].system->first_state_ + state].slot;
  };
  if (read.kind == Read::Kind::kOfTime) return {offsetof(Context::Header, time), 0};
  if (read.kind == Read::Kind::kOfLog) return {offsetof(Context::Header, log), 0};
  if (read.kind == Read::Kind::kState) return state_slot(leaf, read.index);
  if (const int node = NodeOf(leaf, read); node >= 0) return schedule_->nodes[node].out;
  Wiring::Driver driver{leaf, read.index, -1};
  if (read.kind == Read::Kind::kInput) driver = leaves[leaf].drivers[read.index];
  if (driver.none()) return {};
  if (driver.exported >= 0) return schedule_->exported_inputs[driver.exported].slot;
  return state_slot(driver.leaf, leaves[driver.leaf].system->outputs()[driver.output].state);
}

std::uint32_t ScheduleCompiler::AddSlots(int leaf, const Calculation& calculation,
                                         std::span<const Slot> writes) {
  const auto first = static_cast<std::uint32_t>(schedule_->slots.size());
  for (const Read& read : calculation.reads) schedule_->slots.push_back(SlotOf(leaf, read));
  schedule_->slots.insert(schedule_->slots.end(), writes.begin(), writes.end());
  return first;
}

std::pair<std::uint32_t, std::uint32_t> ScheduleCompiler::AddPulls(std::span<const int> wanted) {
  marked_.resize(nodes_.size(), 0);
  found_.clear();
  const auto mark = [&](int node) {
    if (std::exchange(marked_[node], 1) == 0) found_.push_back(node);
  };
  for (const int node : wanted) mark(node);
  for (std::size_t i = 0; i < found_.size(); ++i) {
    for (const int before : nodes_[found_[i]].predecessors) mark(before);
  }
  std::sort(found_.begin(), found_.end());
  for (const int node : found_) marked_[node] = 0;
  const auto begin = static_cast<std::uint32_t>(schedule_->pulls.size());
  schedule_->pulls.insert(schedule_->pulls.end(), found_.begin(), found_.end());
  return {begin, static_cast<std::uint32_t>(schedule_->pulls.size())};
}

void ScheduleCompiler::CompileNodes() {
  const auto& leaves = wiring_.leaves();
  for (int i = 0; i < std::ssize(nodes_); ++i) {
    const NodeInfo& info = nodes_[i];
    const Calculation& calculation = CalculationOf(info);
    Schedule::Node& node = schedule_->nodes[i];
    node.function = calculation.function;
    node.system = leaves[info.leaf].system;
    node.first_slot = AddSlots(info.leaf, calculation, {&node.out, 1});
    std::tie(node.pull_begin, node.pull_end) = AddPulls({&i, 1});
  }
  TellPorts();
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const System& system = *leaves[leaf].system;
    for (const int node : cached_node_of_[leaf]) schedule_->cached_nodes.push_back(node);
    for (std::size_t i = 0; i < system.outputs().size(); ++i) {
      const Read self{Read::Kind::kOutput, static_cast<int>(i)};
      schedule_->outputs[system.first_output_ + i] = {SlotOf(static_cast<int>(leaf), self),
                                                      node_of_[leaf][i]};
    }
    for (std::size_t i = 0; i < system.inputs().size(); ++i) {
      const Read self{Read::Kind::kInput, static_cast<int>(i)};
      const int exported = leaves[leaf].drivers[i].exported;
      schedule_->inputs[system.first_input_ + i] = {
          SlotOf(static_cast<int>(leaf), self),
          exported < 0 ? -1 : schedule_->exported_inputs[exported].source,
          {}};
    }
  }
}

void ScheduleCompiler::TellPorts() {
  for (Schedule::Node& node : schedule_->nodes) node.port = -1;
  std::vector<int> open;
  for (std::size_t leaf = 0; leaf < node_of_.size(); ++leaf) {
    for (int output = 0; output < std::ssize(node_of_[leaf]); ++output) {
      if (node_of_[leaf][output] < 0) continue;
      open.assign(1, node_of_[leaf][output]);
      while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        const NodeInfo& info = nodes_[node];
        const bool own =
            info.leaf == static_cast<int>(leaf) && (info.output < 0 || info.output == output);
        if (!own || schedule_->nodes[node].port >= 0) continue;
        schedule_->nodes[node].port = output;
        open.insert(open.end(), info.predecessors.begin(), info.predecessors.end());
      }
    }
  }
}

void ScheduleCompiler::CompilePlausible() {
  const auto& leaves = wiring_.leaves();
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const auto& inputs = leaves[leaf].system->inputs();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const Plausible* const plausible = inputs[i].spec.plausible.get();
      const Wiring::Driver& driver = leaves[leaf].drivers[i];
      if (plausible == nullptr || driver.none()) continue;
      if (driver.exported >= 0) {
        AddOnce(schedule_->exported_inputs[driver.exported].plausible, plausible);
      } else if (node_of_[driver.leaf][driver.output] < 0) {
        const System& system = *leaves[driver.leaf].system;
        const int state = system.outputs()[driver.output].state;
        const auto sets = [&](const System::EventInfo& event) {
          return event.stage == System::Stage::kInitialization &&
                 std::find(event.writes.begin(), event.writes.end(), state) != event.writes.end();
        };
        const bool set_at_start = std::any_of(system.events().begin(), system.events().end(), sets);
        const Read self{Read::Kind::kOutput, driver.output};
        schedule_->shown_states.push_back({leaves[driver.leaf].system, driver.output,
                                           SlotOf(driver.leaf, self), plausible, set_at_start});
      }
    }
  }
}

void ScheduleCompiler::CompileStates() {
  const auto& leaves = wiring_.leaves();
  std::vector<int> wanted;
  Sources sources;
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const System& system = *leaves[leaf].system;
    for (std::size_t i = 0; i < system.states().size(); ++i) {
      const System::StateInfo& info = system.states()[i];
      if (!info.continuous) continue;
      const int index = static_cast<int>(leaf);
      Slot out = schedule_->states[system.first_state_ + i].slot;
      out.offset = out.offset - schedule_->continuous_offset + schedule_->derivative_offset;
      schedule_->derivatives.push_back({info.derivative.function, &system,
                                        AddSlots(index, info.derivative, {&out, 1}), out,
                                        info.name});
      const auto more = NodesOf(index, info.derivative.reads);
      wanted.insert(wanted.end(), more.begin(), more.end());
      const Sources its = SourcesOf(index, info.derivative.reads);
      sources.insert(sources.end(), its.begin(), its.end());
    }
  }
  std::tie(schedule_->derivative_pull_begin, schedule_->derivative_pull_end) = AddPulls(wanted);
  for (Schedule::StateEntry& state : schedule_->states) {
    state.in_derivatives = std::find(sources.begin(), sources.end(),
                                     static_cast<std::uint32_t>(state.source)) != sources.end();
  }
}

void ScheduleCompiler::CompileWitnesses() {
  const auto& leaves = wiring_.leaves();
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const System& system = *leaves[leaf].system;
    for (const System::WitnessInfo& info : system.witnesses()) {
      const auto offset = schedule_->witnesses_offset +
                          schedule_->witnesses.size() * sizeof(Schedule::WitnessState) +
                          offsetof(Schedule::WitnessState, value);
      Schedule::Witness witness{};
      witness.function = info.calculation.function;
      witness.system = &system;
      const Slot value{static_cast<std::uint32_t>(offset), 1};
      witness.first_slot = AddSlots(static_cast<int>(leaf), info.calculation, {&value, 1});
      std::tie(witness.pull_begin, witness.pull_end) =
          AddPulls(NodesOf(static_cast<int>(leaf), info.calculation.reads));
      witness.name = info.name;
      witness.direction = info.direction;
      schedule_->witnesses.push_back(std::move(witness));
    }
  }
}

void ScheduleCompiler::CompileEvents() {
  const auto& leaves = wiring_.leaves();
  int witnesses = 0;
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const System& system = *leaves[leaf].system;
    const int first_witness =
        std::exchange(witnesses, witnesses + static_cast<int>(system.witnesses().size()));
    for (const System::EventInfo& info : system.events()) {
      Schedule::Event event{};
      event.stage = info.stage;
      event.function = info.calculation.function;
      event.system = &system;
      std::vector<Slot> writes;
      for (const int state : info.writes) {
        event.writes.push_back(system.first_state_ + state);
        writes.push_back(schedule_->states[event.writes.back()].next);
      }
      event.first_slot = AddSlots(static_cast<int>(leaf), info.calculation, writes);
      std::tie(event.pull_begin, event.pull_end) =
          AddPulls(NodesOf(static_cast<int>(leaf), info.calculation.reads));
      const int index = static_cast<int>(schedule_->events.size());
      schedule_->events.push_back(std::move(event));
      if (info.stage == System::Stage::kInitialization) {
        schedule_->initializations.push_back(index);
        continue;
      }
      if (info.witness >= 0) {
        schedule_->witnesses[first_witness + info.witness].events.push_back(index);
        continue;
      }
      for (Schedule::Group& group : schedule_->groups) {
        if (group.stage == info.stage && group.every.period == info.every.period &&
            group.every.offset == info.every.offset) {
          group.events.push_back(index);
        }
      }
    }
  }
}

}  // namespace oca
