// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/schedule_compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

#include "oca/framework/dataflow/error.h"

namespace oca {
namespace {

void AddOnce(std::vector<const Plausible*>& all, const Plausible* one) {
  const auto same = [&](const Plausible* other) { return *other == *one; };
  if (std::none_of(all.begin(), all.end(), same)) all.push_back(one);
}

}  // namespace

std::unique_ptr<Schedule> ScheduleCompiler::Compile(Diagram& root, Wiring& wiring) {
  ScheduleCompiler compiler(root, wiring);
  auto& problems = compiler.wiring_.problems();
  compiler.IndexLeaves();
  compiler.MakeSources();
  compiler.OrderNodes();
  if (!problems.empty()) {
    // The builder may try again; until then no handle may find a schedule that is gone.
    root.schedule_ = nullptr;
    for (auto& leaf : compiler.wiring_.leaves()) leaf.system->schedule_ = nullptr;
    throw WiringError(problems);
  }
  compiler.LayOut();
  compiler.CompileNodes();
  compiler.CompilePlausible();
  compiler.CompileStates();
  compiler.CompileWitnesses();
  compiler.CompileEvents();
  return std::move(compiler.schedule_);
}

ScheduleCompiler::ScheduleCompiler(Diagram& root, Wiring& wiring)
    : root_(root), wiring_(wiring), schedule_(std::make_unique<Schedule>()) {}

void ScheduleCompiler::IndexLeaves() {
  int inputs = 0, outputs = 0, states = 0;
  schedule_->root = &root_;
  root_.schedule_ = schedule_.get();
  for (auto& leaf : wiring_.leaves()) {
    System& system = *leaf.system;
    system.schedule_ = schedule_.get();
    system.first_input_ = std::exchange(inputs, inputs + static_cast<int>(system.inputs().size()));
    system.first_output_ =
        std::exchange(outputs, outputs + static_cast<int>(system.outputs().size()));
    system.first_state_ = std::exchange(states, states + static_cast<int>(system.states().size()));
    system.leaf_ = static_cast<int>(schedule_->systems.size());
    schedule_->systems.push_back(&system);
    schedule_->paths.push_back(leaf.path);
  }
  schedule_->inputs.resize(inputs);
  schedule_->outputs.resize(outputs);
  schedule_->states.resize(states);
  schedule_->exported_inputs.resize(root_.exported_inputs().size());
}

void ScheduleCompiler::MakeSources() {
  schedule_->source_names = {"time", "continuous state"};
  for (std::size_t i = 0; i < wiring_.leaves().size(); ++i) {
    const auto& leaf = wiring_.leaves()[i];
    for (std::size_t k = 0; k < leaf.system->states().size(); ++k) {
      const System::StateInfo& info = leaf.system->states()[k];
      Schedule::StateEntry& entry = schedule_->states[leaf.system->first_state_ + k];
      entry.info = &info;
      entry.type = info.type;
      entry.continuous = info.continuous;
      entry.source = Schedule::kContinuousSource;
      if (!info.continuous) {
        entry.source = static_cast<int>(schedule_->source_names.size());
        schedule_->source_names.push_back(leaf.path + "." + info.name);
      }
    }
  }
  for (std::size_t i = 0; i < schedule_->exported_inputs.size(); ++i) {
    schedule_->exported_inputs[i].source = static_cast<int>(schedule_->source_names.size());
    schedule_->source_names.push_back(root_.exported_inputs()[i].name);
  }
}

int ScheduleCompiler::NodeOf(int leaf, const Read& read) const {
  if (read.kind == Read::Kind::kOutput) return node_of_[leaf][read.index];
  if (read.kind != Read::Kind::kInput) return -1;
  const Wiring::Driver& driver = wiring_.leaves()[leaf].drivers[read.index];
  return driver.leaf < 0 ? -1 : node_of_[driver.leaf][driver.output];
}

std::set<std::uint32_t> ScheduleCompiler::SourcesOf(int leaf, const Read& read) const {
  const auto state_source = [&](int of_leaf, int state) -> std::uint32_t {
    return schedule_->states[wiring_.leaves()[of_leaf].system->first_state_ + state].source;
  };
  if (read.kind == Read::Kind::kOfTime) return {Schedule::kTimeSource};
  if (read.kind == Read::Kind::kState) return {state_source(leaf, read.index)};
  if (const int node = NodeOf(leaf, read); node >= 0) return nodes_[node].sources;
  Wiring::Driver driver;
  if (read.kind == Read::Kind::kInput) driver = wiring_.leaves()[leaf].drivers[read.index];
  if (read.kind == Read::Kind::kOutput) driver = {leaf, read.index, -1};
  if (driver.exported >= 0) {
    return {static_cast<std::uint32_t>(schedule_->exported_inputs[driver.exported].source)};
  }
  if (driver.leaf < 0) return {};
  return {state_source(driver.leaf,
                       wiring_.leaves()[driver.leaf].system->outputs()[driver.output].state)};
}

std::vector<int> ScheduleCompiler::NodesOf(int leaf, const std::vector<Read>& reads) const {
  std::vector<int> nodes;
  for (const Read& read : reads) {
    if (const int node = NodeOf(leaf, read); node >= 0) nodes.push_back(node);
  }
  return nodes;
}

void ScheduleCompiler::OrderNodes() {
  const auto& leaves = wiring_.leaves();
  std::vector<NodeInfo> unordered;
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    node_of_.emplace_back();
    const auto& outputs = leaves[leaf].system->outputs();
    for (std::size_t output = 0; output < outputs.size(); ++output) {
      const bool computed = outputs[output].state < 0;
      node_of_.back().push_back(computed ? static_cast<int>(unordered.size()) : -1);
      if (computed) unordered.push_back({static_cast<int>(leaf), static_cast<int>(output), {}, {}});
    }
  }
  const std::size_t count = unordered.size();
  std::vector<std::vector<int>> predecessors(count), successors(count);
  std::vector<int> open(count, 0), order, position(count, -1);
  for (std::size_t node = 0; node < count; ++node) {
    const auto& info = unordered[node];
    const auto& output = leaves[info.leaf].system->outputs()[info.output];
    predecessors[node] = NodesOf(info.leaf, output.calculation.reads);
    for (const int before : predecessors[node])
      successors[before].push_back(static_cast<int>(node));
    open[node] = static_cast<int>(predecessors[node].size());
    if (open[node] == 0) order.push_back(static_cast<int>(node));
  }
  nodes_ = std::move(unordered);
  bool loops = false;
  for (std::size_t i = 0; i < order.size() || order.size() < count; ++i) {
    if (i == order.size()) {  // the rest is on loops and behind them
      loops = true;
      for (const int node : ReportLoop(open, predecessors)) {
        open[node] = 0;
        order.push_back(node);
      }
    }
    position[order[i]] = static_cast<int>(i);
    for (const int next : successors[order[i]]) {
      if (open[next] > 0 && --open[next] == 0) order.push_back(next);
    }
  }
  if (loops) return;

  std::vector<NodeInfo> ordered;
  for (const int node : order) {
    ordered.push_back(nodes_[node]);
    for (const int before : predecessors[node]) {
      ordered.back().predecessors.push_back(position[before]);
    }
  }
  nodes_ = std::move(ordered);
  for (std::size_t i = 0; i < count; ++i)
    node_of_[nodes_[i].leaf][nodes_[i].output] = static_cast<int>(i);
  for (NodeInfo& node : nodes_) {
    const auto& output = leaves[node.leaf].system->outputs()[node.output];
    for (const Read& read : output.calculation.reads)
      node.sources.merge(SourcesOf(node.leaf, read));
  }
}

std::vector<int> ScheduleCompiler::ReportLoop(const std::vector<int>& open_predecessors,
                                              const std::vector<std::vector<int>>& predecessors) {
  int node = 0;
  while (open_predecessors[node] == 0) ++node;
  std::vector<int> walk;
  while (std::find(walk.begin(), walk.end(), node) == walk.end()) {
    walk.push_back(node);
    node = *std::find_if(predecessors[node].begin(), predecessors[node].end(),
                         [&](int before) { return open_predecessors[before] > 0; });
  }
  walk.erase(walk.begin(), std::find(walk.begin(), walk.end(), node));
  std::reverse(walk.begin(), walk.end());
  std::string path;
  for (std::size_t i = 0; i <= walk.size(); ++i) {
    const NodeInfo& to = nodes_[walk[i % walk.size()]];
    if (i > 0) {
      const auto& leaf = wiring_.leaves()[to.leaf];
      for (const Read& read : leaf.system->outputs()[to.output].calculation.reads) {
        if (read.kind != Read::Kind::kInput || NodeOf(to.leaf, read) != walk[i - 1]) continue;
        path += " -> " + wiring_.NameOfInput(to.leaf, read.index);
        break;
      }
    }
    path += (i > 0 ? " -> " : "") + wiring_.NameOfOutput(to.leaf, to.output);
  }
  wiring_.problems().push_back(fmt::format(
      "algebraic loop: {}; break it with a delay, a hold or any system whose output is a "
      "state",
      path));
  return walk;
}

std::uint32_t ScheduleCompiler::Allocate(std::size_t bytes, std::size_t align) {
  arena_ = (arena_ + align - 1) / align * align;
  const std::size_t offset = arena_;
  arena_ += bytes;
  if (arena_ >= Slot::kNone) throw WiringError({"diagram: its values need more than 4 GB"});
  return static_cast<std::uint32_t>(offset);
}

void ScheduleCompiler::LayOutObject(Slot& slot, const SignalType& type) {
  slot = {Allocate(type.size, type.align), 0};
  schedule_->objects.push_back({slot.offset, &type});
}

void ScheduleCompiler::LayOut() {
  const auto& leaves = wiring_.leaves();
  for (const auto& leaf : leaves) {
    for (const System::EventInfo& event : leaf.system->events()) {
      if (event.stage == System::Stage::kInitialization || event.witness >= 0) continue;
      auto& groups = schedule_->groups;
      const auto same = [&](const Schedule::Group& group) {
        return group.stage == event.stage && group.every.period == event.every.period &&
               group.every.offset == event.every.offset;
      };
      if (std::none_of(groups.begin(), groups.end(), same)) {
        groups.push_back({event.stage, event.every, {}});
      }
    }
  }
  std::map<std::set<std::uint32_t>, std::uint32_t> classes;
  for (const NodeInfo& node : nodes_) classes.emplace(node.sources, classes.size());

  Allocate(sizeof(Context::Header));
  schedule_->versions_offset = Allocate(8 * schedule_->source_names.size());
  schedule_->class_states_offset = Allocate(16 * classes.size());
  schedule_->node_states_offset = Allocate(16 * nodes_.size());
  schedule_->counts_offset = Allocate(8 * schedule_->groups.size());
  std::size_t witnesses = 0;
  for (const auto& leaf : leaves) witnesses += leaf.system->witnesses().size();
  schedule_->witnesses_offset = Allocate(sizeof(Schedule::WitnessState) * witnesses);

  const auto each_state = [&](bool continuous, const auto& visit) {
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
      const auto& states = leaves[leaf].system->states();
      for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i].continuous != continuous || states[i].type != &kVectorType) continue;
        visit(schedule_->states[leaves[leaf].system->first_state_ + i],
              static_cast<std::uint32_t>(
                  wiring_.SizeOf(static_cast<int>(leaf), states[i].spec.size)));
      }
    }
  };
  schedule_->continuous_offset = Allocate(0, 32);
  each_state(true, [&](Schedule::StateEntry& state, std::uint32_t size) {
    state.slot = {Allocate(8 * size), size};
    schedule_->continuous_size += static_cast<int>(size);
  });
  schedule_->derivative_offset = Allocate(8 * schedule_->continuous_size, 32);
  const auto hold = [&](Schedule::StateEntry& state, std::uint32_t size) {
    if (!state.continuous) state.slot = {Allocate(8 * size, 16), size};
    state.next = {Allocate(8 * size, 16), size};
  };
  each_state(false, hold);
  each_state(true, hold);

  for (const NodeInfo& info : nodes_) {
    const auto& output = leaves[info.leaf].system->outputs()[info.output];
    Schedule::Node node{};
    node.type = output.type;
    node.vector = output.type == &kVectorType;
    node.source_class = classes.at(info.sources);
    if (output.type == &kVectorType) {
      node.out.size = static_cast<std::uint32_t>(wiring_.SizeOf(info.leaf, output.spec.size));
      node.out.offset = Allocate(8 * node.out.size, 16);
    }
    schedule_->nodes.push_back(node);
  }
  for (std::size_t i = 0; i < schedule_->exported_inputs.size(); ++i) {
    if (wiring_.exported()[i].empty()) continue;
    const auto& target = wiring_.exported()[i].front();
    const auto& info = leaves[target.leaf].system->inputs()[target.input];
    if (info.type != &kVectorType) continue;
    const auto size = static_cast<std::uint32_t>(wiring_.SizeOf(target.leaf, info.spec.size));
    schedule_->exported_inputs[i].slot = {Allocate(8 * size, 16), size};
  }
  schedule_->plain_size = Allocate(0, 64);

  for (Schedule::StateEntry& state : schedule_->states) {
    if (state.type == &kVectorType) continue;
    LayOutObject(state.slot, *state.type);
    LayOutObject(state.next, *state.type);
  }
  for (Schedule::Node& node : schedule_->nodes) {
    if (node.type != &kVectorType) LayOutObject(node.out, *node.type);
  }
  for (std::size_t i = 0; i < schedule_->exported_inputs.size(); ++i) {
    if (wiring_.exported()[i].empty()) continue;
    const auto& target = wiring_.exported()[i].front();
    const auto& info = leaves[target.leaf].system->inputs()[target.input];
    if (info.type != &kVectorType) LayOutObject(schedule_->exported_inputs[i].slot, *info.type);
  }
  schedule_->arena_size = Allocate(0, 64);

  schedule_->classes.resize(classes.size());
  for (const auto& [sources, index] : classes) {
    const auto begin = static_cast<std::uint32_t>(schedule_->class_sources.size());
    schedule_->class_sources.insert(schedule_->class_sources.end(), sources.begin(), sources.end());
    schedule_->classes[index] = {begin,
                                 static_cast<std::uint32_t>(schedule_->class_sources.size())};
  }
}

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
                                         const std::vector<Slot>& writes) {
  const auto first = static_cast<std::uint32_t>(schedule_->slots.size());
  for (const Read& read : calculation.reads) schedule_->slots.push_back(SlotOf(leaf, read));
  schedule_->slots.insert(schedule_->slots.end(), writes.begin(), writes.end());
  return first;
}

std::pair<std::uint32_t, std::uint32_t> ScheduleCompiler::AddPulls(const std::vector<int>& wanted) {
  marked_.resize(nodes_.size(), 0);
  std::vector<int> found;
  const auto mark = [&](int node) {
    if (std::exchange(marked_[node], 1) == 0) found.push_back(node);
  };
  for (const int node : wanted) mark(node);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const int before : nodes_[found[i]].predecessors) mark(before);
  }
  std::sort(found.begin(), found.end());
  for (const int node : found) marked_[node] = 0;
  const auto begin = static_cast<std::uint32_t>(schedule_->pulls.size());
  schedule_->pulls.insert(schedule_->pulls.end(), found.begin(), found.end());
  return {begin, static_cast<std::uint32_t>(schedule_->pulls.size())};
}

void ScheduleCompiler::CompileNodes() {
  const auto& leaves = wiring_.leaves();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const NodeInfo& info = nodes_[i];
    const auto& output = leaves[info.leaf].system->outputs()[info.output];
    Schedule::Node& node = schedule_->nodes[i];
    node.function = output.calculation.function;
    node.system = leaves[info.leaf].system;
    node.first_slot = AddSlots(info.leaf, output.calculation, {node.out});
    std::tie(node.pull_begin, node.pull_end) = AddPulls({static_cast<int>(i)});
  }
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const System& system = *leaves[leaf].system;
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
  std::set<std::uint32_t> sources;
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const System& system = *leaves[leaf].system;
    for (std::size_t i = 0; i < system.states().size(); ++i) {
      const System::StateInfo& info = system.states()[i];
      if (!info.continuous) continue;
      const int index = static_cast<int>(leaf);
      Slot out = schedule_->states[system.first_state_ + i].slot;
      out.offset = out.offset - schedule_->continuous_offset + schedule_->derivative_offset;
      schedule_->derivatives.push_back({info.derivative.function, &system,
                                        AddSlots(index, info.derivative, {out}), out, info.name});
      const auto more = NodesOf(index, info.derivative.reads);
      wanted.insert(wanted.end(), more.begin(), more.end());
      for (const Read& read : info.derivative.reads) sources.merge(SourcesOf(index, read));
    }
  }
  std::tie(schedule_->derivative_pull_begin, schedule_->derivative_pull_end) = AddPulls(wanted);
  for (Schedule::StateEntry& state : schedule_->states) {
    state.in_derivatives = sources.contains(static_cast<std::uint32_t>(state.source));
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
      witness.first_slot = AddSlots(static_cast<int>(leaf), info.calculation,
                                    {{static_cast<std::uint32_t>(offset), 1}});
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
