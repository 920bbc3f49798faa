// SPDX-License-Identifier: BSD-3-Clause
// What a Diagram answers of its wiring.
#include <algorithm>
#include <iterator>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_name.h"
#include "oca/framework/dataflow/wiring.h"

namespace oca {
namespace {

/// The leaf input that speaks for an input.
Wiring::Target TargetOf(const Wiring& wiring, const InputHandle& input) {
  const std::vector<Wiring::Target> targets = wiring.TargetsOf(input);
  if (targets.empty()) {
    throw WiringError(internal::ForeignText(input, "the diagram that was asked"));
  }
  return targets.front();
}

const Wiring::Driver& FindDriver(const Wiring& wiring, const InputHandle& input) {
  const Wiring::Target target = TargetOf(wiring, input);
  return wiring.leaves()[target.leaf].drivers[target.input];
}

}  // namespace

std::vector<Diagram::Leaf> Diagram::systems() const {
  const std::string inside = this == root_ ? "" : PathOf(*this) + ".";
  std::vector<Leaf> leaves;
  for (const Wiring::Leaf& leaf : wiring().leaves()) {
    if (leaf.path.starts_with(inside)) leaves.push_back({leaf.path, leaf.system});
  }
  return leaves;
}

std::string Diagram::PathOf(const System& system) const { return wiring().PathOf(system); }

std::string Diagram::PathOf(const OutputHandle& output) const {
  return wiring().PathOfOutput(wiring().LeafOf(output), output.index).ToString();
}

std::string Diagram::PathOf(const InputHandle& input) const {
  if (input.system == nullptr || !wiring().Contains(*input.system)) {
    throw WiringError(internal::ForeignText(input, "the diagram that was asked"));
  }
  const std::string path = PathOf(*input.system);
  return (path.empty() ? "" : path + ".") + input.system->inputs().at(input.index).name;
}

std::optional<OutputHandle> Diagram::DriverOf(const InputHandle& input) const {
  const Wiring::Driver& driver = FindDriver(wiring(), input);
  if (driver.leaf < 0) return std::nullopt;
  return OutputHandle{{wiring().leaves()[driver.leaf].system, driver.output}};
}

std::vector<Diagram::Connection> Diagram::DriversOf(const System& leaf) const {
  std::vector<Connection> drivers;
  for (int i = 0; i < std::ssize(leaf.inputs()); ++i) {
    const InputHandle input{{&leaf, i}};
    if (const auto driver = DriverOf(input)) drivers.push_back({*driver, input});
  }
  return drivers;
}

std::optional<InputHandle> Diagram::ExportOf(const InputHandle& input) const {
  const Wiring::Driver& driver = FindDriver(wiring(), input);
  if (driver.exported < 0) return std::nullopt;
  return InputHandle{{root_, driver.exported}};
}

std::vector<InputHandle> Diagram::ReadersOf(const OutputHandle& output) const {
  const int from = wiring().LeafOf(output);
  std::vector<InputHandle> readers;
  for (const Wiring::Leaf& leaf : wiring().leaves()) {
    for (int i = 0; i < std::ssize(leaf.drivers); ++i) {
      const Wiring::Driver& driver = leaf.drivers[i];
      if (driver.leaf == from && driver.output == output.index)
        readers.push_back({{leaf.system, i}});
    }
  }
  return readers;
}

Upstream Diagram::UpstreamOf(const OutputHandle& output, Through through) const {
  return Upstream::Of(wiring(), output, through);
}

Upstream Diagram::UpstreamOf(const InputHandle& input, Through through) const {
  TargetOf(wiring(), input);
  return Upstream::Of(wiring(), input, through);
}

std::vector<const System*> Diagram::LeavesUpstream(
    std::vector<const System*> from, const std::function<bool(const System&)>& ends) const {
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (ends(*from[i])) continue;
    for (const Connection& connection : DriversOf(*from[i])) {
      const System* const driver = connection.from.system;
      if (std::find(from.begin(), from.end(), driver) == from.end()) from.push_back(driver);
    }
  }
  return from;
}

int Diagram::SizeOf(const OutputHandle& output) const {
  const int leaf = wiring().LeafOf(output);
  const OutputInfo& info = output.system->outputs().at(output.index);
  return info.type == &kVectorType ? wiring().SizeOf(leaf, info.spec.size) : 0;
}

int Diagram::SizeOf(const InputHandle& input) const {
  const Wiring::Target target = TargetOf(wiring(), input);
  const InputInfo& info = wiring().InfoOf(target);
  return info.type == &kVectorType ? wiring().SizeOf(target.leaf, info.spec.size) : 0;
}

Unit Diagram::UnitOf(const OutputHandle& output) const {
  const int leaf = wiring().LeafOf(output);
  const OutputInfo& info = output.system->outputs().at(output.index);
  return info.type == &kVectorType ? wiring().UnitOf(leaf, info.spec.unit) : Unit::Any();
}

Unit Diagram::UnitOf(const InputHandle& input) const {
  const Wiring::Target target = TargetOf(wiring(), input);
  const InputInfo& info = wiring().InfoOf(target);
  return info.type == &kVectorType ? wiring().UnitOf(target.leaf, info.spec.unit) : Unit::Any();
}

}  // namespace oca
