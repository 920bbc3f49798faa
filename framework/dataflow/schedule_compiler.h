// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/dataflow/wiring.h"

namespace oca {

/// Turns a wired diagram into a Schedule: orders the calculations, finds what each depends on, and
/// lays all values out in one arena.
class ScheduleCompiler {
 public:
  /// `wiring` is that of the root. throws WiringError with all problems of the diagram.
  static std::unique_ptr<Schedule> Compile(Diagram& root, Wiring& wiring);

 private:
  using Sources = std::vector<std::uint32_t>;  ///< in order, each once
  /// The calculation of an output or of a cached value.
  struct NodeInfo {
    int leaf;
    int output{-1};  ///< -1: a cached value
    int cached{-1};
    std::vector<int> predecessors{};
    Sources sources{};
  };
  const Calculation& CalculationOf(const NodeInfo& node) const;
  const ObjectType& TypeOfNode(const NodeInfo& node) const;

  ScheduleCompiler(Diagram& root, Wiring& wiring);

  void IndexLeaves();
  void MakeSources();
  void FindNodes();
  void OrderNodes();
  /// Finds a loop among the nodes that have open predecessors, and adds it to the problems.
  std::vector<int> ReportLoop(const std::vector<int>& open_predecessors);
  WiringProblem ProblemOfLoop(const std::vector<int>& loop) const;
  void Renumber(const std::vector<int>& order);
  void MakeGroups();
  void MakeClasses();
  void LayOut();
  void LayOutCounters();
  void LayOutStates();
  void LayOutNodes();
  void LayOutObject(Slot& slot, const ObjectType& type);
  void CompileNodes();
  /// Finds for each node the output that its failure is told of.
  void TellPorts();
  void CompilePlausible();
  void CompileStates();
  void CompileWitnesses();
  void CompileEvents();

  /// The node behind an output, a cached value or an input's driver; -1 for what is always up to
  /// date.
  int NodeOf(int leaf, const Read& read) const;
  /// The sources that these depend on.
  Sources SourcesOf(int leaf, const std::vector<Read>& reads) const;
  void AddSources(int leaf, const Read& read, Sources& sources) const;
  Slot SlotOf(int leaf, const Read& read) const;
  std::uint32_t AddSlots(int leaf, const Calculation& calculation, std::span<const Slot> writes);
  /// Appends to schedule_->pulls all nodes that the reads need; returns the range.
  std::pair<std::uint32_t, std::uint32_t> AddPulls(std::span<const int> wanted);
  std::vector<int> NodesOf(int leaf, const std::vector<Read>& reads) const;
  std::uint32_t Allocate(std::size_t bytes, std::size_t align = 8);

  Diagram& root_;
  Wiring& wiring_;
  std::unique_ptr<Schedule> schedule_;
  std::vector<NodeInfo> nodes_;                   // in evaluation order once ordered
  std::vector<std::vector<int>> node_of_;         // leaf, output -> node
  std::vector<std::vector<int>> cached_node_of_;  // leaf, cached value -> node
  std::map<Sources, std::uint32_t> classes_;
  std::vector<char> marked_;  // scratch of AddPulls
  std::vector<int> found_;    // also
  std::size_t arena_{0};
};

}  // namespace oca
