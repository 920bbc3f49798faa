// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/schedule_compiler.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "oca/framework/dataflow/error.h"

namespace oca {
std::unique_ptr<Schedule> ScheduleCompiler::Compile(Diagram& root, Wiring& wiring) {
  ScheduleCompiler compiler(root, wiring);
  auto& problems = compiler.wiring_.problems();
  compiler.IndexLeaves();
  compiler.MakeSources();
  compiler.FindNodes();
  compiler.OrderNodes();
  if (!problems.empty()) {
    // The builder may try again; until then no handle may find a schedule that is gone.
    root.schedule_ = nullptr;
    for (auto& leaf : compiler.wiring_.leaves()) leaf.system->schedule_ = nullptr;
    throw WiringError(problems);
  }
  compiler.MakeGroups();
  compiler.MakeClasses();
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
  int inputs = 0, outputs = 0, cached = 0, states = 0;
  schedule_->root = &root_;
  root_.schedule_ = schedule_.get();
  for (auto& leaf : wiring_.leaves()) {
    System& system = *leaf.system;
    system.schedule_ = schedule_.get();
    system.first_input_ = std::exchange(inputs, inputs + static_cast<int>(system.inputs().size()));
    system.first_output_ =
        std::exchange(outputs, outputs + static_cast<int>(system.outputs().size()));
    system.first_cached_ = std::exchange(cached, cached + static_cast<int>(system.cached().size()));
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
  if (read.kind == Read::Kind::kCached) return cached_node_of_[leaf][read.index];
  if (read.kind != Read::Kind::kInput) return -1;
  const Wiring::Driver& driver = wiring_.leaves()[leaf].drivers[read.index];
  return driver.leaf < 0 ? -1 : node_of_[driver.leaf][driver.output];
}

ScheduleCompiler::Sources ScheduleCompiler::SourcesOf(int leaf,
                                                      const std::vector<Read>& reads) const {
  Sources sources;
  sources.reserve(8);
  for (const Read& read : reads) AddSources(leaf, read, sources);
  std::sort(sources.begin(), sources.end());
  sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
  return sources;
}

void ScheduleCompiler::AddSources(int leaf, const Read& read, Sources& sources) const {
  const auto add_state = [&](int of_leaf, int state) {
    sources.push_back(static_cast<std::uint32_t>(
        schedule_->states[wiring_.leaves()[of_leaf].system->first_state_ + state].source));
  };
  if (read.kind == Read::Kind::kOfTime) return sources.push_back(Schedule::kTimeSource);
  if (read.kind == Read::Kind::kState) return add_state(leaf, read.index);
  if (const int node = NodeOf(leaf, read); node >= 0) {
    const Sources& more = nodes_[node].sources;
    sources.insert(sources.end(), more.begin(), more.end());
    return;
  }
  Wiring::Driver driver;
  if (read.kind == Read::Kind::kInput) driver = wiring_.leaves()[leaf].drivers[read.index];
  if (read.kind == Read::Kind::kOutput) driver = {leaf, read.index, -1};
  if (driver.exported >= 0) {
    sources.push_back(
        static_cast<std::uint32_t>(schedule_->exported_inputs[driver.exported].source));
  } else if (driver.leaf >= 0) {
    add_state(driver.leaf, wiring_.leaves()[driver.leaf].system->outputs()[driver.output].state);
  }
}

std::vector<int> ScheduleCompiler::NodesOf(int leaf, const std::vector<Read>& reads) const {
  std::vector<int> nodes;
  nodes.reserve(reads.size());
  for (const Read& read : reads) {
    if (const int node = NodeOf(leaf, read); node >= 0) nodes.push_back(node);
  }
  return nodes;
}

const Calculation& ScheduleCompiler::CalculationOf(const NodeInfo& node) const {
  const System& system = *wiring_.leaves()[node.leaf].system;
  return node.output >= 0 ? system.outputs()[node.output].calculation
                          : system.cached()[node.cached].calculation;
}

void ScheduleCompiler::FindNodes() {
  const auto& leaves = wiring_.leaves();
  const auto add = [&](std::vector<int>& nodes, NodeInfo info) {
    nodes.push_back(static_cast<int>(nodes_.size()));
    nodes_.push_back(std::move(info));
  };
  nodes_.reserve(2 * schedule_->outputs.size());
  for (int leaf = 0; leaf < std::ssize(leaves); ++leaf) {
    const System& system = *leaves[leaf].system;
    node_of_.emplace_back().reserve(system.outputs().size());
    cached_node_of_.emplace_back().reserve(system.cached().size());
    for (int i = 0; i < std::ssize(system.cached()); ++i) {
      add(cached_node_of_.back(), {.leaf = leaf, .cached = i});
    }
    for (int i = 0; i < std::ssize(system.outputs()); ++i) {
      if (system.outputs()[i].state >= 0) {
        node_of_.back().push_back(-1);
      } else {
        add(node_of_.back(), {.leaf = leaf, .output = i});
      }
    }
  }
  for (NodeInfo& node : nodes_) {
    node.predecessors = NodesOf(node.leaf, CalculationOf(node).reads);
  }
}

void ScheduleCompiler::OrderNodes() {
  const std::size_t count = nodes_.size();
  std::vector<int> open(count, 0), order;
  order.reserve(count);
  std::vector<std::size_t> first(count + 1, 0);  // of each node, into successors
  for (std::size_t node = 0; node < count; ++node) {
    for (const int before : nodes_[node].predecessors) ++first[before + 1];
    open[node] = static_cast<int>(nodes_[node].predecessors.size());
    if (open[node] == 0) order.push_back(static_cast<int>(node));
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> successors(first.back());
  std::vector<std::size_t> next = first;
  for (std::size_t node = 0; node < count; ++node) {
    for (const int before : nodes_[node].predecessors) {
      successors[next[before]++] = static_cast<int>(node);
    }
  }
  bool loops = false;
  for (std::size_t i = 0; i < order.size() || order.size() < count; ++i) {
    if (i == order.size()) {  // the rest is on loops and behind them
      loops = true;
      for (const int node : ReportLoop(open)) {
        open[node] = 0;
        order.push_back(node);
      }
    }
    const auto node = static_cast<std::size_t>(order[i]);
    for (std::size_t k = first[node]; k < first[node + 1]; ++k) {
      const int behind = successors[k];
      if (open[behind] > 0 && --open[behind] == 0) order.push_back(behind);
    }
  }
  if (!loops) Renumber(order);
}

void ScheduleCompiler::Renumber(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) position[order[i]] = static_cast<int>(i);
  std::vector<NodeInfo> ordered;
  ordered.reserve(order.size());
  for (const int node : order) {
    ordered.push_back(std::move(nodes_[node]));
    for (int& before : ordered.back().predecessors) before = position[before];
  }
  nodes_ = std::move(ordered);
  for (auto* const numbers : {&node_of_, &cached_node_of_}) {
    for (std::vector<int>& of_leaf : *numbers) {
      for (int& node : of_leaf) node = node < 0 ? node : position[node];
    }
  }
  for (NodeInfo& node : nodes_) {
    node.sources = SourcesOf(node.leaf, CalculationOf(node).reads);
  }
}

WiringProblem ScheduleCompiler::ProblemOfLoop(const std::vector<int>& loop) const {
  WiringProblem problem{.text = {"algebraic loop: "}};
  const auto add = [&](const PortPath& port) {
    if (problem.text.size() > 1) problem.text.push_back(" -> ");
    problem.text.push_back(port);
  };
  for (std::size_t i = 0; i <= loop.size(); ++i) {
    const NodeInfo& to = nodes_[loop[i % loop.size()]];
    if (i > 0) {
      for (const Read& read : CalculationOf(to).reads) {
        if (read.kind != Read::Kind::kInput || NodeOf(to.leaf, read) != loop[i - 1]) continue;
        problem.inputs.push_back(wiring_.PathOfInput(to.leaf, read.index));
        add(problem.inputs.back());
        break;
      }
    }
    if (to.output >= 0) add(wiring_.PathOfOutput(to.leaf, to.output));
  }
  problem.text.push_back("; break it with a delay, a hold or any system whose output is a state");
  return problem;
}

std::vector<int> ScheduleCompiler::ReportLoop(const std::vector<int>& open_predecessors) {
  int node = 0;
  while (open_predecessors[node] == 0) ++node;
  std::vector<int> walk;
  while (std::find(walk.begin(), walk.end(), node) == walk.end()) {
    walk.push_back(node);
    const auto& predecessors = nodes_[node].predecessors;
    node = *std::find_if(predecessors.begin(), predecessors.end(),
                         [&](int before) { return open_predecessors[before] > 0; });
  }
  walk.erase(walk.begin(), std::find(walk.begin(), walk.end(), node));
  std::reverse(walk.begin(), walk.end());
  // The path begins with an output, the first of those that the diagram has on it; a loop has one,
  // for only ports lead from system to system.
  const auto rank = [&](int i) { return std::pair(nodes_[i].output < 0, i); };
  const auto first = std::min_element(walk.begin(), walk.end(),
                                      [&](int one, int other) { return rank(one) < rank(other); });
  std::rotate(walk.begin(), first, walk.end());
  wiring_.problems().push_back(ProblemOfLoop(walk));
  return walk;
}

}  // namespace oca
