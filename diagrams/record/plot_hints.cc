// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/record/plot_hints.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "systems/delta_limiter.h"

namespace oca::record {
namespace {

using diagrams::LoadedDiagram;
using nlohmann::ordered_json;

bool Recorded(const LoadedDiagram& loaded, const std::string& name) {
  return std::any_of(loaded.record.begin(), loaded.record.end(),
                     [&](const auto& signal) { return signal.name == name; });
}

/// The held delta of a limiter that has the same robot, if that one is recorded and `delta` is not.
OutputHandle RecordedDelta(const LoadedDiagram& loaded, const diagrams::SignalFacts& facts,
                           const OutputHandle& delta) {
  if (Recorded(loaded, loaded.diagram->PathOf(delta))) return delta;
  for (const OutputHandle& other : facts.OutputsOf("DeltaLimiter", kVectorType.name)) {
    const bool same_robot = facts.RobotOf(other) == facts.RobotOf(delta);
    if (same_robot && Recorded(loaded, loaded.diagram->PathOf(other))) return other;
  }
  return delta;
}

/// What an overlay applies of a limited delta, if that is recorded and the delta itself is not.
OutputHandle AppliedDelta(const LoadedDiagram& loaded, const OutputHandle& limited) {
  if (Recorded(loaded, loaded.diagram->PathOf(limited))) return limited;
  for (const LoadedDiagram::Block& block : loaded.systems) {
    if (block.type != "DeltaOverlay") continue;
    const auto delta = loaded.diagram->DriverOf(loaded.diagram->FindInput(block.name + ".delta"));
    const OutputHandle applied =
        loaded.diagram->FindSystem(block.name)->FindOutput("applied_delta");
    const bool same = delta && *delta == limited;
    if (same && Recorded(loaded, loaded.diagram->PathOf(applied))) return applied;
  }
  return limited;
}

std::string TopicOf(const LoadedDiagram& loaded, const OutputHandle& output) {
  std::string topic = "/" + loaded.diagram->PathOf(output);
  std::replace(topic.begin(), topic.end(), '.', '/');
  return topic;
}

/// The numbers of a parameter; none if it has its default.
std::vector<double> NumbersAt(const LoadedDiagram::Block& block, const char* key) {
  const Value* const value = block.params.Find(key);
  std::vector<double> numbers(1);
  if (value == nullptr) return {};
  if (value->number(numbers[0])) return numbers;
  numbers.clear();
  for (const Value& item : value->list() == nullptr ? Value::List{} : *value->list()) {
    double number = 0.0;
    if (item.number(number)) numbers.push_back(number);
  }
  return numbers;
}

bool SwitchedOff(const LoadedDiagram::Block& block) {
  const Value* const enabled = block.params.Find("enabled");
  return enabled != nullptr && enabled->boolean() != nullptr && !*enabled->boolean();
}

/// A multiple of a system's own period of at least 10 ms: its instants are events of every run.
Period SamplingOf(const LoadedDiagram::Block& block) {
  constexpr double kFinest = 0.01;  // s
  const std::vector<double> period = NumbersAt(block, "period");
  if (period.size() != 1 || !(period[0] > 0.0)) return {};
  const Period own = Period::FromSeconds(period[0]);
  const auto times =
      static_cast<std::int64_t>(std::max(1.0, std::ceil(kFinest / period[0] - 1e-9)));
  return Period(own.numerator() * times, own.denominator());
}

}  // namespace

std::vector<LimitHint> LimitHintsOf(const LoadedDiagram& loaded) {
  std::vector<LimitHint> hints;
  for (const LoadedDiagram::Block& block : loaded.systems) {
    if (SwitchedOff(block)) continue;
    const System& system = *loaded.diagram->FindSystem(block.name);
    LimitHint hint{block.name, block.type, "", {}, {}, SamplingOf(block)};
    if (block.type == "DeltaLimiter") {
      hint.kind = "rate";
      hint.bound = NumbersAt(block, "max_joint_velocity");
      if (hint.bound.empty()) hint.bound = {systems::DeltaLimiter::Params{}.max_joint_velocity[0]};
      hint.output = AppliedDelta(loaded, system.FindOutput("limited_delta"));
    } else if (block.type == "RepulsiveField") {
      const auto proximities =
          loaded.diagram->DriverOf(loaded.diagram->FindInput(block.name + ".proximities"));
      hint.kind = "below";
      hint.bound = NumbersAt(block, "max_distance");
      if (!proximities || hint.bound.empty()) continue;
      hint.output = *proximities;
      hint.period = {};
    } else if (block.type == "SafetyFilter") {
      hint.kind = "bounds";
      hint.output = system.FindOutput("activity");
    } else if (block.type == "MotionLimiter") {
      hint.kind = "clips";
      hint.output = system.FindOutput("clips");
    } else {
      continue;
    }
    hints.push_back(std::move(hint));
  }
  return hints;
}

std::string LimitHintsJson(const LoadedDiagram& loaded, const std::vector<LimitHint>& hints) {
  ordered_json list = ordered_json::array();
  for (const LimitHint& hint : hints) {
    ordered_json json{{"system", hint.system},
                      {"type", hint.type},
                      {"kind", hint.kind},
                      {"signal", TopicOf(loaded, hint.output)}};
    if (hint.bound.size() == 1) json["bound"] = hint.bound[0];
    if (hint.bound.size() > 1) json["bound"] = hint.bound;
    list.push_back(json);
  }
  return list.dump();
}

std::vector<PlotHint> PlotHintsOf(const LoadedDiagram& loaded, const diagrams::SignalFacts& facts) {
  PlotHint requested{"requested", "Requested joints", ""};
  PlotHint delta{"delta", "Deltas of the avoidance", ""};
  PlotHint final_joints{"final", "Final joints", ""};
  PlotHint distance{"distance", "Distances", "m"};
  PlotHint speed{"speed", "Joint speeds", ""};
  for (const LoadedDiagram::Block& block : loaded.systems) {
    if (block.type == "RepulsiveField") {
      const Value* const value = block.params.Find("max_distance");
      double limit = 0.0;
      if (value != nullptr && value->number(limit)) {
        distance.limit = std::max(limit, distance.limit.value_or(limit));
      }
    }
    if (block.type != "MotionMetrics") continue;
    if (const auto output =
            loaded.diagram->DriverOf(loaded.diagram->FindInput(block.name + ".request"))) {
      requested.outputs.push_back(*output);
    }
    if (const auto output =
            loaded.diagram->DriverOf(loaded.diagram->FindInput(block.name + ".delta"))) {
      delta.outputs.push_back(RecordedDelta(loaded, facts, *output));
    }
    if (const auto output =
            loaded.diagram->DriverOf(loaded.diagram->FindInput(block.name + ".position"))) {
      final_joints.outputs.push_back(*output);
    }
  }
  distance.outputs = facts.OutputsOf("BulletDistance", "ProximitySet");
  for (const OutputHandle& output : facts.OutputsOf("IntegratorPlant", kVectorType.name)) {
    if (loaded.diagram->PathOf(output).ends_with(".velocity")) speed.outputs.push_back(output);
  }
  std::vector<PlotHint> hints;
  for (PlotHint* hint : {&requested, &delta, &final_joints, &distance, &speed}) {
    if (hint->outputs.empty()) continue;
    if (hint->unit.empty()) hint->unit = loaded.diagram->UnitOf(hint->outputs.front()).ToString();
    hints.push_back(std::move(*hint));
  }
  return hints;
}

std::string PlotHintsJson(const LoadedDiagram& loaded, const std::vector<PlotHint>& hints) {
  ordered_json list = ordered_json::array();
  for (const PlotHint& hint : hints) {
    ordered_json topics = ordered_json::array();
    for (const OutputHandle& output : hint.outputs) topics.push_back(TopicOf(loaded, output));
    ordered_json json{
        {"id", hint.id}, {"title", hint.title}, {"unit", hint.unit}, {"topics", topics}};
    if (hint.limit) json["limit"] = *hint.limit;
    list.push_back(json);
  }
  return list.dump();
}

}  // namespace oca::record
