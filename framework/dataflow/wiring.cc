// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/wiring.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "oca/framework/dataflow/error.h"

namespace oca {
namespace {

/// One side of a constraint: a value, or a variable that is the value plus a shift.
template <class Value>
struct Term {
  std::optional<Value> value;
  int variable{-1};  // global
  int shift{0};
  std::string port;
};

int Shift(int value, int /*shift*/) { return value; }
Unit Shift(const Unit& value, int shift) { return value.Rate(shift); }
std::string Show(int value) { return std::to_string(value); }
std::string Show(const Unit& value) { return value.ToString(); }

/// Settles variables from equalities by propagation and reports each equality that fails.
template <class Value>
class Equalities {
 public:
  explicit Equalities(std::size_t variables) : values_(variables) {}

  void Add(Term<Value> from, Term<Value> to) { all_.emplace_back(std::move(from), std::move(to)); }

  void Settle() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : all_) {
        const bool forth = Spread(a, b);
        changed |= Spread(b, a) || forth;
      }
    }
  }

  void Report(const char* what, std::vector<std::string>& problems) const {
    for (const auto& [a, b] : all_) {
      const auto x = Get(a);
      const auto y = Get(b);
      if (!x || !y || *x == *y) continue;
      problems.push_back(fmt::format("{} -> {}: {}; got {}; expected {}", a.port, b.port, what,
                                     Show(*x), Show(*y)));
    }
  }

  const std::optional<Value>& operator[](std::size_t variable) const { return values_[variable]; }

 private:
  std::optional<Value> Get(const Term<Value>& term) const {
    if (term.value) return term.value;
    if (term.variable < 0 || !values_[term.variable]) return std::nullopt;
    return Shift(*values_[term.variable], term.shift);
  }
  bool Spread(const Term<Value>& from, const Term<Value>& to) {
    const auto value = Get(from);
    if (!value || to.value || to.variable < 0 || values_[to.variable]) return false;
    values_[to.variable] = Shift(*value, -to.shift);
    return true;
  }

  std::vector<std::pair<Term<Value>, Term<Value>>> all_;
  std::vector<std::optional<Value>> values_;
};

/// Calls visit(from spec, from leaf, from name, to spec, to leaf, to name) for every connection
/// between vector ports, and between the inputs that share one exported input.
template <class Visit>
void VisitVectorPairs(const Wiring& wiring, const Visit& visit) {
  const auto& leaves = wiring.leaves();
  for (int leaf = 0; leaf < static_cast<int>(leaves.size()); ++leaf) {
    const System& system = *leaves[leaf].system;
    for (int input = 0; input < static_cast<int>(system.inputs().size()); ++input) {
      const Wiring::Driver& driver = leaves[leaf].drivers[input];
      if (driver.leaf < 0 || system.inputs()[input].type != &kVectorType) continue;
      const auto& output = leaves[driver.leaf].system->outputs()[driver.output];
      if (output.type != &kVectorType) continue;
      visit(output.spec, driver.leaf, wiring.NameOfOutput(driver.leaf, driver.output),
            system.inputs()[input].spec, leaf, wiring.NameOfInput(leaf, input));
    }
  }
  for (const auto& targets : wiring.exported()) {
    for (std::size_t i = 1; i < targets.size(); ++i) {
      const auto& first = leaves[targets[0].leaf].system->inputs()[targets[0].input];
      const auto& other = leaves[targets[i].leaf].system->inputs()[targets[i].input];
      if (first.type != &kVectorType || other.type != &kVectorType) continue;
      visit(first.spec, targets[0].leaf, wiring.NameOfInput(targets[0].leaf, targets[0].input),
            other.spec, targets[i].leaf, wiring.NameOfInput(targets[i].leaf, targets[i].input));
    }
  }
}

}  // namespace

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
  if (from == index_.end()) {
    problems_.push_back(
        fmt::format("{}connections: an output of a system outside this diagram", prefix));
    return;
  }
  const std::vector<Target> targets = TargetsOf(connection.to);
  if (targets.empty()) {
    problems_.push_back(
        fmt::format("{}connections: an input of a system outside this diagram", prefix));
  }
  for (const Target& target : targets) {
    const Driver driver{from->second, connection.from.index, -1};
    const SignalType* const got = leaves_[from->second].system->outputs()[driver.output].type;
    if (got != InfoOf(target).type) {
      problems_.push_back(fmt::format("{} -> {}: type; got {}; expected {}", NameOfDriver(driver),
                                      NameOfInput(target.leaf, target.input), got->name,
                                      InfoOf(target).type->name));
    }
    Drive(target, driver);
  }
}

void Wiring::ExportAll(const Diagram& root) {
  for (const Diagram::ExportedInput& exported : root.exported_inputs()) {
    exported_.emplace_back();
    for (const InputHandle& input : exported.to) {
      const std::vector<Target> targets = TargetsOf(input);
      if (targets.empty()) {
        problems_.push_back(fmt::format(
            "exported input '{}': an input of a system outside this diagram", exported.name));
      }
      for (const Target& target : targets) {
        Driver driver;
        driver.exported = static_cast<int>(exported_.size()) - 1;
        Drive(target, driver);
        exported_.back().push_back(target);
        if (InfoOf(target).type != InfoOf(exported_.back().front()).type) {
          problems_.push_back(fmt::format("{} -> {}: type; got {}; expected {}", exported.name,
                                          NameOfInput(target.leaf, target.input),
                                          InfoOf(exported_.back().front()).type->name,
                                          InfoOf(target).type->name));
        }
      }
    }
  }
}

void Wiring::CheckExportedOutputs() {
  for (const auto& [name, output] : root_.exported_outputs()) {
    if (index_.contains(output.system)) continue;
    problems_.push_back(
        fmt::format("exported output '{}': an output of a system outside this diagram", name));
  }
}

void Wiring::Drive(const Target& target, const Driver& driver) {
  Driver& present = leaves_[target.leaf].drivers[target.input];
  if (!present.none()) {
    problems_.push_back(fmt::format("{}: two drivers; got {} and {}; expected one",
                                    NameOfInput(target.leaf, target.input), NameOfDriver(present),
                                    NameOfDriver(driver)));
    return;
  }
  present = driver;
}

void Wiring::CheckUnconnected() {
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const auto& inputs = leaves_[leaf].system->inputs();
    for (std::size_t input = 0; input < inputs.size(); ++input) {
      if (!leaves_[leaf].drivers[input].none() || inputs[input].optional) continue;
      problems_.push_back(fmt::format("{}: input not connected; expected an output of type {}",
                                      NameOfInput(static_cast<int>(leaf), static_cast<int>(input)),
                                      inputs[input].type->name));
    }
  }
}

void Wiring::SettleSizes() {
  std::vector<int> first;
  int count = 0;
  for (const Leaf& leaf : leaves_) {
    first.push_back(count);
    count += leaf.system->size_variables();
  }
  Equalities<int> sizes(count);
  const auto term = [&](const PortSpec& spec, int leaf, std::string port) {
    Term<int> result{{}, -1, 0, std::move(port)};
    if (spec.size.variable() >= 0) {
      result.variable = first[leaf] + spec.size.variable();
    } else {
      result.value = spec.size.number();
    }
    return result;
  };
  VisitVectorPairs(*this, [&](const PortSpec& from, int from_leaf, std::string from_name,
                              const PortSpec& to, int to_leaf, std::string to_name) {
    sizes.Add(term(from, from_leaf, std::move(from_name)), term(to, to_leaf, std::move(to_name)));
  });
  for (std::size_t i = 0; i < exported_.size(); ++i) {
    const Diagram::ExportedInput& exported = root_.exported_inputs()[i];
    if (exported.size < 0 || exported_[i].empty()) continue;
    const Target& target = exported_[i].front();
    if (InfoOf(target).type != &kVectorType) continue;
    sizes.Add({exported.size, -1, 0, exported.name},
              term(InfoOf(target).spec, target.leaf, NameOfInput(target.leaf, target.input)));
  }
  sizes.Settle();
  sizes.Report("size", problems_);
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const int variables = leaves_[leaf].system->size_variables();
    for (int i = 0; i < variables; ++i) {
      leaves_[leaf].sizes.push_back(sizes[first[leaf] + i].value_or(1));
    }
  }
}

void Wiring::SettleUnits() {
  std::vector<int> first;
  int count = 0;
  for (const Leaf& leaf : leaves_) {
    first.push_back(count);
    count += leaf.system->unit_variables();
  }
  Equalities<Unit> units(count);
  const auto term = [&](const PortSpec& spec, int leaf, std::string port) {
    Term<Unit> result{{}, -1, 0, std::move(port)};
    if (spec.unit.variable() >= 0) {
      result.variable = first[leaf] + spec.unit.variable();
      result.shift = spec.unit.rates();
    } else if (!spec.unit.any()) {
      result.value = spec.unit;
    }
    return result;
  };
  VisitVectorPairs(*this, [&](const PortSpec& from, int from_leaf, std::string from_name,
                              const PortSpec& to, int to_leaf, std::string to_name) {
    units.Add(term(from, from_leaf, std::move(from_name)), term(to, to_leaf, std::move(to_name)));
  });
  units.Settle();
  units.Report("unit", problems_);
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const int variables = leaves_[leaf].system->unit_variables();
    for (int i = 0; i < variables; ++i) {
      leaves_[leaf].units.push_back(units[first[leaf] + i].value_or(Unit::Any()));
    }
  }
}

void Wiring::CheckInitialValues() {
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    for (const System::StateInfo& state : leaves_[leaf].system->states()) {
      const std::string name = fmt::format("{}.{}", leaves_[leaf].path, state.name);
      if (state.type == &kVectorType && !state.initial.scalar()) {
        const int size = SizeOf(static_cast<int>(leaf), state.spec.size);
        if (state.initial.values().size() != size) {
          problems_.push_back(fmt::format("{}: initial value; got {} numbers; expected {}", name,
                                          state.initial.values().size(), size));
        }
      }
      if (state.type == &kVectorType && !state.initial.values().allFinite()) {
        problems_.push_back(
            fmt::format("{}: initial value; got a NaN or an infinity; expected "
                        "finite numbers",
                        name));
      }
      if (state.continuous && state.derivative.function == nullptr) {
        problems_.push_back(fmt::format("{}: continuous state without a derivative", name));
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

int Wiring::LeafOf(const Handle& port) const {
  const auto found = index_.find(port.system);
  if (found != index_.end()) return found->second;
  throw WiringError({"port: its system is not part of the diagram that was asked"});
}

std::string Wiring::PathOf(const System& system) const {
  if (const auto leaf = index_.find(&system); leaf != index_.end()) {
    return leaves_[leaf->second].path;
  }
  if (const auto nested = diagram_paths_.find(&system); nested != diagram_paths_.end()) {
    return nested->second;
  }
  throw WiringError({"system: it is not part of the diagram that was asked"});
}

const System::InputInfo& Wiring::InfoOf(const Target& target) const {
  return leaves_[target.leaf].system->inputs()[target.input];
}

std::string Wiring::NameOfInput(int leaf, int input) const {
  return leaves_[leaf].path + "." + leaves_[leaf].system->inputs()[input].name;
}

std::string Wiring::NameOfOutput(int leaf, int output) const {
  return leaves_[leaf].path + "." + leaves_[leaf].system->outputs()[output].name;
}

std::string Wiring::NameOfDriver(const Driver& driver) const {
  if (driver.exported >= 0) {
    return fmt::format("the exported input '{}'", root_.exported_inputs()[driver.exported].name);
  }
  return NameOfOutput(driver.leaf, driver.output);
}

}  // namespace oca
