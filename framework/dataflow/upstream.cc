// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/upstream.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "oca/framework/dataflow/wiring.h"

namespace oca {
namespace {

/// Walks level by level: all within a connection's reach before what lies behind the next.
class UpstreamWalk {
 public:
  UpstreamWalk(const Wiring& wiring, Through through) : wiring_(wiring), through_(through) {}

  void Add(int leaf, const Read& read) { level_.emplace_back(leaf, read); }

  Upstream Go() {
    for (; !level_.empty(); ++connections_) {
      std::vector<std::pair<int, Read>> next;
      // What a system reads of its own comes to the end of the level.
      for (std::size_t i = 0; i < level_.size(); ++i) {
        const auto [leaf, read] = level_[i];
        if (seen_.emplace(leaf, static_cast<int>(read.kind), read.index).second) {
          Follow(leaf, read, next);
        }
      }
      level_ = std::move(next);
    }
    return std::move(found_);
  }

 private:
  void Follow(int leaf, const Read& read, std::vector<std::pair<int, Read>>& next) {
    const System& system = *wiring_.leaves()[leaf].system;
    if (read.kind == Read::Kind::kOfTime) found_.time = true;
    if (read.kind == Read::Kind::kOutput) {
      found_.outputs.push_back({{{&system, read.index}}, connections_});
      const System::OutputInfo& output = system.outputs()[read.index];
      if (output.state >= 0) Add(leaf, {Read::Kind::kState, output.state});
      AddReads(leaf, output.calculation);
    }
    if (read.kind == Read::Kind::kCached) AddReads(leaf, system.cached()[read.index].calculation);
    if (read.kind == Read::Kind::kInput) {
      const Wiring::Driver& driver = wiring_.leaves()[leaf].drivers[read.index];
      if (driver.exported >= 0) AddExported(driver.exported);
      if (driver.leaf >= 0) next.push_back({driver.leaf, {Read::Kind::kOutput, driver.output}});
    }
    if (read.kind == Read::Kind::kState) {
      found_.states.push_back({{&system, read.index}});
      if (through_ == Through::kStates) AddState(leaf, system, read.index);
    }
  }

  void AddState(int leaf, const System& system, int state) {
    AddReads(leaf, system.states()[state].derivative);
    for (const System::EventInfo& event : system.events()) {
      const auto& writes = event.writes;
      if (std::find(writes.begin(), writes.end(), state) == writes.end()) continue;
      AddReads(leaf, event.calculation);
      if (event.witness >= 0) AddReads(leaf, system.witnesses()[event.witness].calculation);
    }
  }

  void AddReads(int leaf, const Calculation& calculation) {
    for (const Read& read : calculation.reads) Add(leaf, read);
  }

  void AddExported(int index) {
    const InputHandle input{{&wiring_.root(), index}};
    const auto same = [&](const InputHandle& other) { return other.index == index; };
    if (std::none_of(found_.exported.begin(), found_.exported.end(), same)) {
      found_.exported.push_back(input);
    }
  }

  const Wiring& wiring_;
  const Through through_;
  std::vector<std::pair<int, Read>> level_;  // by leaf
  std::set<std::tuple<int, int, int>> seen_;
  int connections_{0};
  Upstream found_;
};

}  // namespace

Upstream Upstream::Of(const Wiring& wiring, const OutputHandle& output, Through through) {
  UpstreamWalk walk(wiring, through);
  walk.Add(wiring.LeafOf(output), {Read::Kind::kOutput, output.index});
  return walk.Go();
}

Upstream Upstream::Of(const Wiring& wiring, const InputHandle& input, Through through) {
  UpstreamWalk walk(wiring, through);
  for (const Wiring::Target& target : wiring.TargetsOf(input)) {
    walk.Add(target.leaf, {Read::Kind::kInput, target.input});
  }
  return walk.Go();
}

}  // namespace oca
