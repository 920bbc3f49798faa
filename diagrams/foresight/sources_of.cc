// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/sources_of.h"

#include <set>
#include <utility>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/systems/signals/roles.h"

namespace oca::foresight {
namespace {

class SourceWalk {
 public:
  SourceWalk(const Diagram& diagram, const std::function<bool(const System&)>& counts)
      : diagram_(diagram), counts_(counts) {}

  void From(const OutputHandle& output) {
    if (!seen_.insert({output.system, output.index}).second) return;
    if (counts_(*output.system)) {
      found_.push_back(output);
      return;
    }
    const SignalType* const type = &TypeOfPort(output);
    for (const auto& [before, connections] :
         diagram_.UpstreamOf(output, Through::kStates).outputs) {
      if (connections == 1 && &TypeOfPort(before) == type) From(before);
    }
  }

  std::vector<OutputHandle> found() { return std::move(found_); }

 private:
  const Diagram& diagram_;
  const std::function<bool(const System&)>& counts_;
  std::set<std::pair<const System*, int>> seen_;
  std::vector<OutputHandle> found_;
};

}  // namespace

std::vector<OutputHandle> SourcesOf(const Diagram& diagram, const InputHandle& input,
                                    const std::function<bool(const System&)>& counts) {
  SourceWalk walk(diagram, counts);
  if (const auto driver = systems::RolePort(input).In(diagram)) walk.From(*driver);
  return walk.found();
}

}  // namespace oca::foresight
