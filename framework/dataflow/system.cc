// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/system.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "oca/framework/dataflow/check_name.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca {
namespace {

template <class Infos>
int IndexOf(const Infos& infos, const std::string& name, const char* kind) {
  for (const auto& info : infos) {
    if (info.name == name) return static_cast<int>(&info - infos.data());
  }
  std::vector<std::string> names;
  for (const auto& info : infos) names.push_back(info.name);
  throw WiringError(
      fmt::format("no {} port '{}'{}; {} ports are: {}", kind, name, DidYouMean(name, names), kind,
                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

/// Of a port that is about to be declared.
template <class Infos>
void CheckPortName(const Infos& infos, const std::string& name, const char* kind) {
  internal::CheckName(name, kind);
  for (const auto& info : infos) {
    if (info.name == name) throw WiringError(fmt::format("{} name: '{}' is taken", kind, name));
  }
}

}  // namespace

System::~System() = default;

InputHandle System::FindInput(const std::string& name) const {
  return {{this, IndexOf(inputs_, name, "input")}};
}

OutputHandle System::FindOutput(const std::string& name) const {
  return {{this, IndexOf(outputs_, name, "output")}};
}

Size System::DeclareSize(
    std::initializer_list<std::pair<const char*, const PerComponent*>> parameters) {
  const std::pair<const char*, const PerComponent*>* list = nullptr;
  for (const auto& parameter : parameters) {
    if (parameter.second->scalar()) continue;
    if (list != nullptr && list->second->values().size() != parameter.second->values().size()) {
      throw ConfigError(fmt::format("{}: got {} numbers; expected {} as in {}", parameter.first,
                                    parameter.second->values().size(),
                                    list->second->values().size(), list->first));
    }
    if (list == nullptr) list = &parameter;
  }
  return list == nullptr ? DeclareSize() : Size(static_cast<int>(list->second->values().size()));
}

InputHandle System::AddInput(InputInfo info) {
  CheckPortName(inputs_, info.name, "input");
  if (info.type != &kVectorType && info.type->read_json == nullptr) {
    throw WiringError(
        fmt::format("input '{}': type; got {}, which is not read from JSON; expected "
                    "one that is",
                    info.name, info.type->name));
  }
  inputs_.push_back(std::move(info));
  return {{this, static_cast<int>(inputs_.size()) - 1}};
}

void System::CheckReads(const std::string& what, const Calculation& calculation) const {
  for (std::size_t i = 0; i < calculation.reads.size(); ++i) {
    const Read& read = calculation.reads[i];
    const auto check = [&](const char* kind, std::size_t count) {
      if (read.system == this && read.index >= 0 && read.index < static_cast<int>(count)) return;
      throw WiringError(fmt::format(
          "{}: reads; got {} of another system in place {}; expected one declared before it", what,
          kind, i));
    };
    if (read.kind == Read::Kind::kInput) check("an input", inputs_.size());
    if (read.kind == Read::Kind::kOutput) check("an output", outputs_.size());
    if (read.kind == Read::Kind::kCached) check("a cached value", cached_.size());
    if (read.kind == Read::Kind::kState) check("a state", states_.size());
  }
}

OutputHandle System::AddOutput(OutputInfo info) {
  CheckPortName(outputs_, info.name, "output");
  if (info.type != &kVectorType && info.type->write_json == nullptr) {
    throw WiringError(
        fmt::format("output '{}': type; got {}, which is not written as JSON; "
                    "expected one that is",
                    info.name, info.type->name));
  }
  CheckReads("output '" + info.name + "'", info.calculation);
  outputs_.push_back(std::move(info));
  return {{this, static_cast<int>(outputs_.size()) - 1}};
}

CachedHandle System::AddCached(CachedInfo info) {
  CheckReads("cached value", info.calculation);
  cached_.push_back(std::move(info));
  return {{this, static_cast<int>(cached_.size()) - 1}};
}

OutputHandle System::AddStateOutput(std::string name, const StateHandle& state) {
  const int index = StateIndex(state);
  const StateInfo& shown = states_.at(index);
  return AddOutput({std::move(name), shown.type, shown.spec, {}, index});
}

StateHandle System::AddState(StateInfo info) {
  states_.push_back(std::move(info));
  return {{this, static_cast<int>(states_.size()) - 1}};
}

int System::StateIndex(const StateHandle& state) const {
  const int count = static_cast<int>(states_.size());
  if (state.system == this && state.index >= 0 && state.index < count) return state.index;
  throw WiringError("state: shown or written; got one of another system; expected one of its own");
}

void System::SetDerivative(const StateHandle& state, Calculation calculation) {
  StateInfo& driven = states_[StateIndex(state)];
  CheckReads(fmt::format("derivative of '{}'", driven.name), calculation);
  driven.derivative = std::move(calculation);
}

Witness System::AddWitness(WitnessInfo info) {
  CheckReads(fmt::format("witness '{}'", info.name), info.calculation);
  for (const WitnessInfo& other : witnesses_) {
    if (other.name != info.name) continue;
    throw WiringError(fmt::format("witness '{}' is declared twice", info.name));
  }
  witnesses_.push_back(std::move(info));
  return {{this, static_cast<int>(witnesses_.size()) - 1}};
}

int System::WitnessIndex(const Witness& witness) const {
  if (witness.system == this) return witness.index;
  throw WiringError("reset: its witness is not of this system; expected one declared before it");
}

void System::AddEvent(EventInfo info) {
  constexpr const char* kNames[] = {"initialization", "reset", "update", "publish"};
  CheckReads(kNames[static_cast<int>(info.stage)], info.calculation);
  const bool timed = info.witness < 0;
  if (timed && info.stage != Stage::kInitialization && !info.every.period.positive()) {
    throw ConfigError(fmt::format("period: got {}; expected > 0 s", info.every.period.ToString()));
  }
  for (const int state : info.writes) {
    if (info.stage == Stage::kUpdate && states_.at(state).continuous) {
      throw WiringError(fmt::format("state '{}' is continuous: only a reset may write it",
                                    states_.at(state).name));
    }
    for (const EventInfo& other : events_) {
      if (other.stage != info.stage || !timed || other.witness >= 0) continue;
      for (const int written : other.writes) {
        if (written != state) continue;
        throw WiringError(fmt::format("state '{}' is written by two events of one stage",
                                      states_.at(state).name));
      }
    }
  }
  events_.push_back(std::move(info));
}

}  // namespace oca
