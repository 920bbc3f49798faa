// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/signal_facts.h"

#include "oca/framework/dataflow/dynamic_port.h"

namespace oca::runs {

SignalFacts::SignalFacts(const loading::LoadedDiagram& loaded) : loaded_(loaded) {
  ClaimModels();
  SpreadClaims();
}

std::vector<OutputHandle> SignalFacts::VectorsAt(const System& system) const {
  std::vector<OutputHandle> vectors;
  for (const auto& info : system.outputs()) {
    if (info.type == &kVectorType) vectors.push_back(system.FindOutput(info.name));
  }
  for (const auto& [from, to] : loaded_.diagram->DriversOf(system)) {
    if (&TypeOfPort(from) == &kVectorType) vectors.push_back(from);
  }
  return vectors;
}

bool SignalFacts::Claim(const System& system, const std::string& robot) {
  const int positions = loaded_.models.Get(robot)->num_positions();
  bool changed = false;
  for (const OutputHandle& output : VectorsAt(system)) {
    if (loaded_.diagram->SizeOf(output) != positions) continue;
    changed |= robots_.emplace(Key{output.system, output.index}, robot).second;
  }
  return changed;
}

/// A system that names a robot reads and writes vectors of its joints.
void SignalFacts::ClaimModels() {
  for (const loading::LoadedDiagram::Block& block : loaded_.systems) {
    if (block.row == nullptr || !block.row->needs_models) continue;
    const Value* const model = block.params.Find("model");
    const std::string name = block.models->FullName(
        model != nullptr && model->string() != nullptr ? *model->string() : "");
    if (!name.empty()) Claim(*loaded_.diagram->FindSystem(block.name), name);
  }
}

/// What a system makes of vectors of joints are such vectors again if they are as long.
void SignalFacts::SpreadClaims() {
  for (bool changed = true; changed;) {
    changed = false;
    for (const loading::LoadedDiagram::Block& block : loaded_.systems) {
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

}  // namespace oca::runs
