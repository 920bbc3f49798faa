// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/wiring.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_name.h"

namespace oca {
Wiring::Wiring(const Diagram& root) : root_(root) {
  diagram_paths_[&root] = "";
  Flatten(root, "");
  ConnectAll(root, "");
  ExportAll(root);
  CheckExportedOutputs();
  CheckUnconnected();
  SettleSizes();
  SettleUnits();
  CheckInitialValues();
}

void Wiring::Flatten(const Diagram& diagram, const std::string& prefix) {
  for (const Diagram::Child& child : diagram.children()) {
    const std::string path = prefix + child.name;
    if (const auto* nested = dynamic_cast<const Diagram*>(child.system.get())) {
      diagram_paths_[nested] = path;
      Flatten(*nested, path + ".");
      continue;
    }
    index_[child.system.get()] = static_cast<int>(leaves_.size());
    leaves_.push_back({child.system.get(), path, {}, {}, {}});
    leaves_.back().drivers.resize(child.system->inputs().size());
  }
}

std::vector<Wiring::Target> Wiring::TargetsOf(const InputHandle& input) const {
  if (const auto found = index_.find(input.system); found != index_.end()) {
    return {{found->second, input.index}};
  }
  std::vector<Target> targets;
  if (!diagram_paths_.contains(input.system)) return targets;
  const auto* nested = dynamic_cast<const Diagram*>(input.system);
  if (nested == nullptr) return targets;
  for (const InputHandle& inner : nested->exported_inputs().at(input.index).to) {
    const auto more = TargetsOf(inner);
    targets.insert(targets.end(), more.begin(), more.end());
  }
  return targets;
}

void Wiring::ConnectAll(const Diagram& diagram, const std::string& prefix) {
  for (const Diagram::Connection& connection : diagram.connections()) Connect(connection, prefix);
  for (const Diagram::Child& child : diagram.children()) {
    if (const auto* nested = dynamic_cast<const Diagram*>(child.system.get())) {
      ConnectAll(*nested, prefix + child.name + ".");
    }
  }
}

void Wiring::Connect(const Diagram::Connection& connection, const std::string& prefix) {
  const auto from = index_.find(connection.from.system);
  const std::vector<Target> targets = TargetsOf(connection.to);
  const auto add = [&](const Handle& end, const char* kind) {
    problems_.push_back(
        {{prefix + "connections: ", NameOfEnd(connection.from), " -> ", NameOfEnd(connection.to),
          end.system == nullptr
              ? fmt::format(": got a handle that was made by default; expected an {}", kind)
              : fmt::format(": an {} of a system outside this diagram", kind)}});
  };
  if (from == index_.end()) add(connection.from, "output");
  if (targets.empty()) add(connection.to, "input");
  if (from == index_.end()) return;
  for (const Target& target : targets) {
    const Driver driver{from->second, connection.from.index, -1};
    const SignalType* const got = leaves_[from->second].system->outputs()[driver.output].type;
    if (got != InfoOf(target).type) {
      AddProblem(target, {NameOfDriver(driver), " -> ", PathOfInput(target.leaf, target.input),
                          fmt::format(": type; got {}; expected {}", got->name,
                                      InfoOf(target).type->name)});
    }
    Drive(target, driver);
  }
}

void Wiring::ExportAll(const Diagram& root) {
  for (const Diagram::ExportedInput& exported : root.exported_inputs()) {
    exported_.emplace_back();
    CheckPathOf(exported);
    for (const InputHandle& input : exported.to) {
      const std::vector<Target> targets = TargetsOf(input);
      if (targets.empty()) {
        problems_.push_back(
            {{fmt::format("exported input '{}': an input of a system outside this diagram, {}",
                          exported.name, internal::NameOf(input))}});
      }
      for (const Target& target : targets) {
        Driver driver;
        driver.exported = static_cast<int>(exported_.size()) - 1;
        Drive(target, driver);
        exported_.back().push_back(target);
        if (InfoOf(target).type != InfoOf(exported_.back().front()).type) {
          AddProblem(target, {exported.name, " -> ", PathOfInput(target.leaf, target.input),
                              fmt::format(": type; got {}; expected {}",
                                          InfoOf(exported_.back().front()).type->name,
                                          InfoOf(target).type->name)});
        }
      }
    }
  }
}

/// A name that is a path leads to none but its own port inside.
void Wiring::CheckPathOf(const Diagram::ExportedInput& exported) {
  const std::size_t dot = exported.name.rfind('.');
  const System* const inside =
      dot == std::string::npos ? nullptr : root_.FindSystem(exported.name.substr(0, dot));
  if (inside == nullptr) return;
  for (const InputHandle& input : exported.to) {
    if (input.system == inside &&
        inside->inputs()[input.index].name == exported.name.substr(dot + 1)) {
      continue;
    }
    problems_.push_back(
        {{fmt::format("exported input '{}': got another port than the one inside "
                      "with that path; expected another name",
                      exported.name)}});
    return;
  }
}

void Wiring::CheckExportedOutputs() {
  for (const auto& [name, output] : root_.exported_outputs()) {
    if (index_.contains(output.system)) continue;
    problems_.push_back(
        {{fmt::format("exported output '{}': an output of a system outside this diagram, {}", name,
                      internal::NameOf(output))}});
  }
}

void Wiring::Drive(const Target& target, const Driver& driver) {
  Driver& present = leaves_[target.leaf].drivers[target.input];
  if (!present.none()) {
    AddProblem(target, {PathOfInput(target.leaf, target.input), ": two drivers; got ",
                        NameOfDriver(present), " and ", NameOfDriver(driver), "; expected one"});
    return;
  }
  present = driver;
}

void Wiring::CheckUnconnected() {
  for (int leaf = 0; leaf < std::ssize(leaves_); ++leaf) {
    const auto& inputs = leaves_[leaf].system->inputs();
    for (int input = 0; input < std::ssize(inputs); ++input) {
      if (!leaves_[leaf].drivers[input].none() || inputs[input].optional) continue;
      AddProblem({leaf, input}, {PathOfInput(leaf, input),
                                 fmt::format(": input not connected; expected an output of type {}",
                                             inputs[input].type->name)});
    }
  }
}

void Wiring::CheckInitialValues() {
  for (int leaf = 0; leaf < std::ssize(leaves_); ++leaf) {
    for (const System::StateInfo& state : leaves_[leaf].system->states()) {
      const auto add = [&](const std::string& what) {
        const std::string& path = leaves_[leaf].path;
        problems_.push_back({.text = {PortPath{path, state.name}, ": " + what}, .system = path});
      };
      if (state.type == &kVectorType && !state.initial.scalar()) {
        const int size = SizeOf(leaf, state.spec.size);
        if (state.initial.values().size() != size) {
          add(fmt::format("initial value; got {} numbers; expected {}",
                          state.initial.values().size(), size));
        }
      }
      if (state.type == &kVectorType && !state.initial.values().allFinite()) {
        add("initial value; got a NaN or an infinity; expected finite numbers");
      }
      if (state.continuous && state.derivative.function == nullptr) {
        add("continuous state without a derivative");
      }
    }
  }
}

int Wiring::SizeOf(int leaf, const Size& size) const {
  return size.variable() < 0 ? size.number() : leaves_[leaf].sizes[size.variable()];
}

Unit Wiring::UnitOf(int leaf, const Unit& unit) const {
  if (unit.variable() < 0) return unit;
  const Unit& settled = leaves_[leaf].units[unit.variable()];
  return settled.any() ? settled : settled.Rate(unit.rates());
}

int Wiring::LeafOf(const OutputHandle& output) const {
  const auto found = index_.find(output.system);
  if (found != index_.end()) return found->second;
  throw WiringError(internal::ForeignText(output, "the diagram that was asked"));
}

std::string Wiring::PathOf(const System& system) const {
  if (const auto leaf = index_.find(&system); leaf != index_.end()) {
    return leaves_[leaf->second].path;
  }
  if (const auto nested = diagram_paths_.find(&system); nested != diagram_paths_.end()) {
    return nested->second;
  }
  throw WiringError("system: it is not part of the diagram that was asked");
}

const System::InputInfo& Wiring::InfoOf(const Target& target) const {
  return leaves_[target.leaf].system->inputs()[target.input];
}

PortPath Wiring::PathOfInput(int leaf, int input) const {
  return {leaves_[leaf].path, leaves_[leaf].system->inputs()[input].name};
}

PortPath Wiring::PathOfOutput(int leaf, int output) const {
  return {leaves_[leaf].path, leaves_[leaf].system->outputs()[output].name};
}

WiringProblem::Part Wiring::NameOfDriver(const Driver& driver) const {
  if (driver.exported >= 0) {
    return fmt::format("the exported input '{}'", root_.exported_inputs()[driver.exported].name);
  }
  return PathOfOutput(driver.leaf, driver.output);
}

WiringProblem::Part Wiring::NameOfEnd(const OutputHandle& output) const {
  const auto leaf = index_.find(output.system);
  if (leaf == index_.end()) return internal::NameOf(output);
  return PathOfOutput(leaf->second, output.index);
}

WiringProblem::Part Wiring::NameOfEnd(const InputHandle& input) const {
  const auto leaf = index_.find(input.system);
  if (leaf != index_.end()) return PathOfInput(leaf->second, input.index);
  const auto* const nested =
      diagram_paths_.contains(input.system) ? dynamic_cast<const Diagram*>(input.system) : nullptr;
  if (nested == nullptr) return internal::NameOf(input);
  return PortPath{diagram_paths_.at(nested), nested->inputs().at(input.index).name};
}

void Wiring::AddProblem(const Target& target, std::vector<WiringProblem::Part> text) {
  problems_.push_back({.text = std::move(text),
                       .inputs = {PathOfInput(target.leaf, target.input)},
                       .system = leaves_[target.leaf].path});
}

}  // namespace oca
