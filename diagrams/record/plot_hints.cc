// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/record/plot_hints.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace oca::record {
namespace {

using diagrams::LoadedDiagram;
using nlohmann::ordered_json;

bool Recorded(const LoadedDiagram& loaded, const std::string& name) {
  return std::any_of(loaded.record.begin(), loaded.record.end(),
                     [&](const auto& signal) { return signal.name == name; });
}

/// The held delta of a limiter that has the same robot, if that one is recorded and `delta` is not.
OutputHandle RecordedDelta(const LoadedDiagram& loaded, const SignalFacts& facts,
                           const OutputHandle& delta) {
  if (Recorded(loaded, facts.NameOf(delta))) return delta;
  for (const OutputHandle& other : facts.OutputsOf("DeltaLimiter", kVectorType.name)) {
    const bool same_robot = facts.RobotOf(other) == facts.RobotOf(delta);
    if (same_robot && Recorded(loaded, facts.NameOf(other))) return other;
  }
  return delta;
}

}  // namespace

std::vector<PlotHint> PlotHintsOf(const LoadedDiagram& loaded, const SignalFacts& facts) {
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
    if (const auto output = facts.DriverOf(block.name, "request")) {
      requested.outputs.push_back(*output);
    }
    if (const auto output = facts.DriverOf(block.name, "delta")) {
      delta.outputs.push_back(RecordedDelta(loaded, facts, *output));
    }
    if (const auto output = facts.DriverOf(block.name, "position")) {
      final_joints.outputs.push_back(*output);
    }
  }
  distance.outputs = facts.OutputsOf("BulletDistance", "ProximitySet");
  for (const OutputHandle& output : facts.OutputsOf("IntegratorPlant", kVectorType.name)) {
    if (facts.NameOf(output).ends_with(".velocity")) speed.outputs.push_back(output);
  }
  std::vector<PlotHint> hints;
  for (PlotHint* hint : {&requested, &delta, &final_joints, &distance, &speed}) {
    if (hint->outputs.empty()) continue;
    if (hint->unit.empty()) hint->unit = facts.UnitOf(hint->outputs.front());
    hints.push_back(std::move(*hint));
  }
  return hints;
}

std::string PlotHintsJson(const std::vector<PlotHint>& hints, const SignalFacts& facts) {
  ordered_json list = ordered_json::array();
  for (const PlotHint& hint : hints) {
    ordered_json topics = ordered_json::array();
    for (const OutputHandle& output : hint.outputs) {
      std::string topic = "/" + facts.NameOf(output);
      std::replace(topic.begin(), topic.end(), '.', '/');
      topics.push_back(topic);
    }
    ordered_json json{
        {"id", hint.id}, {"title", hint.title}, {"unit", hint.unit}, {"topics", topics}};
    if (hint.limit) json["limit"] = *hint.limit;
    list.push_back(json);
  }
  return list.dump();
}

}  // namespace oca::record
