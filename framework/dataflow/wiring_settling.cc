// SPDX-License-Identifier: BSD-3-Clause
// Lengths and units that are variables, settled from what is connected.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/wiring.h"

namespace oca {
namespace {

/// One side of a constraint: a value, or a variable that is the value plus a shift.
template <class Value>
struct Term {
  std::optional<Value> value;
  int variable{-1};  // global
  int shift{0};
  PortPath port;
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

  void Report(const std::string& what, std::vector<WiringProblem>& problems) const {
    for (const auto& [a, b] : all_) {
      const auto x = Get(a);
      const auto y = Get(b);
      if (!x || !y || *x == *y) continue;
      const std::string rest = fmt::format(": {}; got {}; expected {}", what, Show(*x), Show(*y));
      problems.push_back({{a.port, " -> ", b.port, rest}, {b.port}, b.port.system});
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

/// Calls visit(from spec, from leaf, from port, to spec, to leaf, to port) for every connection
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
      visit(output.spec, driver.leaf, wiring.PathOfOutput(driver.leaf, driver.output),
            system.inputs()[input].spec, leaf, wiring.PathOfInput(leaf, input));
    }
  }
  for (const auto& targets : wiring.exported()) {
    for (std::size_t i = 1; i < targets.size(); ++i) {
      const auto& first = leaves[targets[0].leaf].system->inputs()[targets[0].input];
      const auto& other = leaves[targets[i].leaf].system->inputs()[targets[i].input];
      if (first.type != &kVectorType || other.type != &kVectorType) continue;
      visit(first.spec, targets[0].leaf, wiring.PathOfInput(targets[0].leaf, targets[0].input),
            other.spec, targets[i].leaf, wiring.PathOfInput(targets[i].leaf, targets[i].input));
    }
  }
}

}  // namespace

void Wiring::SettleSizes() {
  std::vector<int> first;
  int count = 0;
  for (const Leaf& leaf : leaves_) {
    first.push_back(count);
    count += leaf.system->size_variables();
  }
  Equalities<int> sizes(count);
  const auto term = [&](const PortSpec& spec, int leaf, PortPath port) {
    Term<int> result{{}, -1, 0, std::move(port)};
    if (spec.size.variable() >= 0) {
      result.variable = first[leaf] + spec.size.variable();
    } else {
      result.value = spec.size.number();
    }
    return result;
  };
  VisitVectorPairs(*this, [&](const PortSpec& from, int from_leaf, PortPath from_port,
                              const PortSpec& to, int to_leaf, PortPath to_port) {
    sizes.Add(term(from, from_leaf, std::move(from_port)), term(to, to_leaf, std::move(to_port)));
  });
  for (std::size_t i = 0; i < exported_.size(); ++i) {
    const Diagram::ExportedInput& exported = root_.exported_inputs()[i];
    if (exported.size < 0 || exported_[i].empty()) continue;
    const Target& target = exported_[i].front();
    if (InfoOf(target).type != &kVectorType) continue;
    sizes.Add({exported.size, -1, 0, {"", exported.name}},
              term(InfoOf(target).spec, target.leaf, PathOfInput(target.leaf, target.input)));
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
  const auto term = [&](const PortSpec& spec, int leaf, PortPath port) {
    Term<Unit> result{{}, -1, 0, std::move(port)};
    if (spec.unit.variable() >= 0) {
      result.variable = first[leaf] + spec.unit.variable();
      result.shift = spec.unit.rates();
    } else if (!spec.unit.any()) {
      result.value = spec.unit;
    }
    return result;
  };
  VisitVectorPairs(*this, [&](const PortSpec& from, int from_leaf, PortPath from_port,
                              const PortSpec& to, int to_leaf, PortPath to_port) {
    units.Add(term(from, from_leaf, std::move(from_port)), term(to, to_leaf, std::move(to_port)));
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

}  // namespace oca
