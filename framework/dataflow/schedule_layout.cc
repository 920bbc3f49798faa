// SPDX-License-Identifier: BSD-3-Clause
// Where in a Context everything lies: first what may be copied as bytes, then objects.
#include <algorithm>
#include <cstddef>
#include <iterator>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/schedule_compiler.h"

namespace oca {

void ScheduleCompiler::MakeGroups() {
  for (const auto& leaf : wiring_.leaves()) {
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
}

void ScheduleCompiler::MakeClasses() {
  for (const NodeInfo& node : nodes_) {
    classes_.try_emplace(node.sources, static_cast<std::uint32_t>(classes_.size()));
  }
  schedule_->classes.resize(classes_.size());
  for (const auto& [sources, index] : classes_) {
    const auto begin = static_cast<std::uint32_t>(schedule_->class_sources.size());
    schedule_->class_sources.insert(schedule_->class_sources.end(), sources.begin(), sources.end());
    schedule_->classes[index] = {begin,
                                 static_cast<std::uint32_t>(schedule_->class_sources.size())};
  }
}

std::uint32_t ScheduleCompiler::Allocate(std::size_t bytes, std::size_t align) {
  arena_ = (arena_ + align - 1) / align * align;
  const std::size_t offset = arena_;
  arena_ += bytes;
  if (arena_ >= Slot::kNone) throw WiringError("diagram: its values need more than 4 GB");
  return static_cast<std::uint32_t>(offset);
}

void ScheduleCompiler::LayOut() {
  LayOutCounters();
  LayOutStates();
  LayOutNodes();
  const auto exported_type = [&](std::size_t i) -> const System::InputInfo* {
    const auto& targets = wiring_.exported()[i];
    return targets.empty() ? nullptr : &wiring_.InfoOf(targets.front());
  };
  for (std::size_t i = 0; i < schedule_->exported_inputs.size(); ++i) {
    const System::InputInfo* const info = exported_type(i);
    if (info == nullptr || info->type != &kVectorType) continue;
    const int leaf = wiring_.exported()[i].front().leaf;
    const auto size = static_cast<std::uint32_t>(wiring_.SizeOf(leaf, info->spec.size));
    schedule_->exported_inputs[i].slot = {Allocate(8 * size, 16), size};
  }
  schedule_->plain_size = Allocate(0, 64);

  for (Schedule::StateEntry& state : schedule_->states) {
    if (state.type == &kVectorType) continue;
    LayOutObject(state.slot, *state.type);
    LayOutObject(state.next, *state.type);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const ObjectType& type = TypeOfNode(nodes_[i]);
    if (&type != &kVectorType) LayOutObject(schedule_->nodes[i].out, type);
  }
  for (std::size_t i = 0; i < schedule_->exported_inputs.size(); ++i) {
    const System::InputInfo* const info = exported_type(i);
    if (info == nullptr || info->type == &kVectorType) continue;
    LayOutObject(schedule_->exported_inputs[i].slot, *info->type);
  }
  schedule_->arena_size = Allocate(0, 64);
}

void ScheduleCompiler::LayOutObject(Slot& slot, const ObjectType& type) {
  slot = {Allocate(type.size, type.align), 0};
  schedule_->objects.push_back({slot.offset, &type});
}

void ScheduleCompiler::LayOutCounters() {
  Allocate(sizeof(Context::Header));
  schedule_->versions_offset = Allocate(8 * schedule_->source_names.size());
  schedule_->class_states_offset = Allocate(16 * classes_.size());
  schedule_->node_states_offset = Allocate(16 * nodes_.size());
  schedule_->counts_offset = Allocate(8 * schedule_->groups.size());
  std::size_t witnesses = 0;
  for (const auto& leaf : wiring_.leaves()) witnesses += leaf.system->witnesses().size();
  schedule_->witnesses_offset = Allocate(sizeof(Schedule::WitnessState) * witnesses);
}

void ScheduleCompiler::LayOutStates() {
  const auto& leaves = wiring_.leaves();
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
}

void ScheduleCompiler::LayOutNodes() {
  schedule_->nodes.reserve(nodes_.size());
  for (const NodeInfo& info : nodes_) {
    const System& system = *wiring_.leaves()[info.leaf].system;
    Schedule::Node node{};
    node.source_class = classes_.at(info.sources);
    if (info.output >= 0) {
      const System::OutputInfo& output = system.outputs()[info.output];
      node.type = output.type;
      node.vector = output.type == &kVectorType;
      if (node.vector) {
        node.out.size = static_cast<std::uint32_t>(wiring_.SizeOf(info.leaf, output.spec.size));
        node.out.offset = Allocate(8 * node.out.size, 16);
      }
    }
    schedule_->nodes.push_back(node);
  }
}

const ObjectType& ScheduleCompiler::TypeOfNode(const NodeInfo& node) const {
  const System& system = *wiring_.leaves()[node.leaf].system;
  if (node.output >= 0) return *system.outputs()[node.output].type;
  return *system.cached()[node.cached].type;
}

}  // namespace oca
