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

/// A vector port of a leaf.
struct VectorPort {
  int leaf;
  const std::string& name;
  const PortSpec& spec;
};

/// One side of a constraint: a value, or a variable that is the value plus a shift.
template <class Value>
struct Term {
  const Wiring::Leaf* leaf{nullptr};  // nullptr: of the root
  const std::string* port{nullptr};
  std::optional<Value> value{};
  int variable{-1};  // global
  int shift{0};
  PortPath Path() const { return {leaf == nullptr ? "" : leaf->path, *port}; }
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
      problems.push_back({{a.Path(), " -> ", b.Path(), rest}, {b.Path()}, b.Path().system});
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

/// Calls visit(from, to) for every connection between vector ports, and between the inputs that
/// share one exported input.
template <class Visit>
void VisitVectorPairs(const Wiring& wiring, const Visit& visit) {
  const auto& leaves = wiring.leaves();
  for (int leaf = 0; leaf < static_cast<int>(leaves.size()); ++leaf) {
    const System& system = *leaves[leaf].system;
    for (int i = 0; i < static_cast<int>(system.inputs().size()); ++i) {
      const Wiring::Driver& driver = leaves[leaf].drivers[i];
      const System::InputInfo& input = system.inputs()[i];
      if (driver.leaf < 0 || input.type != &kVectorType) continue;
      const auto& output = leaves[driver.leaf].system->outputs()[driver.output];
      if (output.type != &kVectorType) continue;
      visit(VectorPort{driver.leaf, output.name, output.spec},
            VectorPort{leaf, input.name, input.spec});
    }
  }
  for (const auto& targets : wiring.exported()) {
    for (std::size_t i = 1; i < targets.size(); ++i) {
      const System::InputInfo& first = wiring.InfoOf(targets[0]);
      const System::InputInfo& other = wiring.InfoOf(targets[i]);
      if (first.type != &kVectorType || other.type != &kVectorType) continue;
      visit(VectorPort{targets[0].leaf, first.name, first.spec},
            VectorPort{targets[i].leaf, other.name, other.spec});
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
  const auto term = [&](const VectorPort& port) {
    Term<int> result{&leaves_[port.leaf], &port.name};
    if (port.spec.size.variable() >= 0) {
      result.variable = first[port.leaf] + port.spec.size.variable();
    } else {
      result.value = port.spec.size.number();
    }
    return result;
  };
  VisitVectorPairs(*this, [&](const VectorPort& from, const VectorPort& to) {
    sizes.Add(term(from), term(to));
  });
  for (std::size_t i = 0; i < exported_.size(); ++i) {
    const Diagram::ExportedInput& exported = root_.exported_inputs()[i];
    if (exported.size < 0 || exported_[i].empty()) continue;
    const Target& target = exported_[i].front();
    const System::InputInfo& input = InfoOf(target);
    if (input.type != &kVectorType) continue;
    sizes.Add({nullptr, &exported.name, exported.size},
              term({target.leaf, input.name, input.spec}));
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
  const auto term = [&](const VectorPort& port) {
    Term<Unit> result{&leaves_[port.leaf], &port.name};
    const Unit& unit = port.spec.unit;
    if (unit.variable() >= 0) {
      result.variable = first[port.leaf] + unit.variable();
      result.shift = unit.rates();
    } else if (!unit.any()) {
      result.value = unit;
    }
    return result;
  };
  VisitVectorPairs(*this, [&](const VectorPort& from, const VectorPort& to) {
    units.Add(term(from), term(to));
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
