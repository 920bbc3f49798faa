// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/signal_facts.h"

#include <fmt/format.h>

#include "framework/dynamic_port.h"
#include "framework/error.h"

namespace oca::diagrams {

SignalFacts::SignalFacts(const LoadedDiagram& loaded, const Context& context)
    : loaded_(loaded), context_(context) {
  for (const auto& block : loaded.systems) blocks_[loaded.diagram->FindSystem(block.name)] = &block;
  for (const auto& connection : loaded.diagram->connections()) {
    drivers_[{connection.to.system, connection.to.index}] = connection.from;
  }
  SettleUnits();
  ClaimModels();
  SpreadClaims();
}

void SignalFacts::SettleUnits() {
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [to, from] : drivers_) {
      const Unit& written = from.system->outputs()[from.index].spec.unit;
      const Unit& read = to.first->inputs()[to.second].spec.unit;
      if (const auto unit = SettledOf(from.system, written)) {
        changed |= SettleFrom(to.first, read, *unit);
      } else if (const auto other = SettledOf(to.first, read)) {
        changed |= SettleFrom(from.system, written, *other);
      }
    }
  }
}

std::optional<SignalFacts::Settled> SignalFacts::SettledOf(const System* system,
                                                           const Unit& unit) const {
  if (unit.any()) return std::nullopt;
  if (unit.variable() < 0) {
    // rad/s^2 and the second rate of rad are one.
    const std::size_t slash = unit.text().find("/s");
    if (slash == std::string::npos) return Settled{unit.text(), unit.rates()};
    const std::string rest = unit.text().substr(slash + 2);
    if (!rest.empty() && rest != "^2") return Settled{unit.text(), unit.rates()};
    return Settled{unit.text().substr(0, slash), unit.rates() + (rest.empty() ? 1 : 2)};
  }
  const auto found = units_.find({system, unit.variable()});
  if (found == units_.end()) return std::nullopt;
  return Settled{found->second.text, found->second.rates + unit.rates()};
}

bool SignalFacts::SettleFrom(const System* system, const Unit& unit, const Settled& settled) {
  if (unit.any() || unit.variable() < 0) return false;
  return units_
      .emplace(Key{system, unit.variable()}, Settled{settled.text, settled.rates - unit.rates()})
      .second;
}

std::string SignalFacts::UnitOf(const OutputHandle& output) const {
  const auto unit = SettledOf(output.system, output.system->outputs()[output.index].spec.unit);
  if (!unit || unit->rates < 0) return "";
  if (unit->rates == 0) return unit->text;
  return unit->rates == 1 ? unit->text + "/s" : fmt::format("{}/s^{}", unit->text, unit->rates);
}

std::vector<OutputHandle> SignalFacts::VectorsAt(const System& system) const {
  std::vector<OutputHandle> vectors;
  for (const auto& info : system.outputs()) {
    if (info.type == &kVectorType) vectors.push_back(system.FindOutput(info.name));
  }
  for (std::size_t i = 0; i < system.inputs().size(); ++i) {
    if (system.inputs()[i].type != &kVectorType) continue;
    const auto driver = drivers_.find({&system, static_cast<int>(i)});
    if (driver != drivers_.end()) vectors.push_back(driver->second);
  }
  return vectors;
}

bool SignalFacts::Claim(const System& system, const std::string& robot) {
  const int positions = loaded_.models.Get(robot)->num_positions();
  bool changed = false;
  for (const OutputHandle& output : VectorsAt(system)) {
    if (VectorSize(output, context_) != positions) continue;
    changed |= robots_.emplace(Key{output.system, output.index}, robot).second;
  }
  return changed;
}

/// A system that names a robot reads and writes vectors of its joints.
void SignalFacts::ClaimModels() {
  for (const LoadedDiagram::Block& block : loaded_.systems) {
    if (!block.row->needs_models) continue;
    const Value* const model = block.params.Find("model");
    std::string name = model != nullptr && model->string() != nullptr ? *model->string() : "";
    if (name.empty() && loaded_.models.all().size() == 1)
      name = loaded_.models.all().begin()->first;
    if (!name.empty()) Claim(*loaded_.diagram->FindSystem(block.name), name);
  }
}

/// What a system makes of vectors of joints are such vectors again if they are as long.
void SignalFacts::SpreadClaims() {
  for (bool changed = true; changed;) {
    changed = false;
    for (const LoadedDiagram::Block& block : loaded_.systems) {
      const System& system = *loaded_.diagram->FindSystem(block.name);
      for (const OutputHandle& output : VectorsAt(system)) {
        const std::string robot = RobotOf(output);
        if (!robot.empty()) changed |= Claim(system, robot);
      }
    }
  }
}

std::string SignalFacts::RobotOf(const OutputHandle& output) const {
  const auto found = robots_.find({output.system, output.index});
  return found == robots_.end() ? "" : found->second;
}

std::vector<std::string> SignalFacts::JointsOf(const OutputHandle& output) const {
  std::vector<std::string> joints;
  const std::string robot = RobotOf(output);
  if (robot.empty()) return joints;
  for (const models::Name& joint : loaded_.models.Get(robot)->position_names()) {
    joints.push_back(joint.text());
  }
  return joints;
}

std::optional<OutputHandle> SignalFacts::DriverOf(const std::string& system,
                                                  const std::string& input) const {
  const System* const found = loaded_.diagram->FindSystem(system);
  if (found == nullptr) return std::nullopt;
  for (std::size_t i = 0; i < found->inputs().size(); ++i) {
    if (found->inputs()[i].name != input) continue;
    const auto driver = drivers_.find({found, static_cast<int>(i)});
    if (driver != drivers_.end()) return driver->second;
  }
  return std::nullopt;
}

std::string SignalFacts::NameOf(const OutputHandle& output) const {
  return BlockOf(output.system)->name + "." + output.system->outputs()[output.index].name;
}

std::vector<OutputHandle> SignalFacts::OutputsOf(const std::string& system_type,
                                                 const std::string& signal_type) const {
  std::vector<OutputHandle> found;
  for (const auto& block : loaded_.systems) {
    if (!system_type.empty() && block.type != system_type) continue;
    const System* const system = loaded_.diagram->FindSystem(block.name);
    for (const auto& output : system->outputs()) {
      if (output.type->name == signal_type) found.push_back(system->FindOutput(output.name));
    }
  }
  return found;
}

const LoadedDiagram::Block* SignalFacts::BlockOf(const System* system) const {
  return blocks_.at(system);
}

}  // namespace oca::diagrams
