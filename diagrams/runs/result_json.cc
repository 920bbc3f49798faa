// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/result_json.h"

#include "oca/diagrams/runs/blind_spots.h"
#include "oca/diagrams/runs/metrics_tree.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::runs {
namespace {

using nlohmann::ordered_json;
using systems::Metric;
using systems::MotionMetricsValue;

ordered_json TreeOf(const Metric::Value& value) {
  if (const double* const number = std::get_if<double>(&value)) return *number;
  const auto* const pair = std::get_if<std::array<models::Name, 2>>(&value);
  return pair == nullptr ? ordered_json() : ordered_json{(*pair)[0].text(), (*pair)[1].text()};
}

/// std::nullopt if it is no value of a metric.
std::optional<Metric::Value> ValueOf(const ordered_json& tree) {
  if (tree.is_null()) return Metric::Value();
  if (tree.is_number()) return Metric::Value(tree.get<double>());
  const bool names =
      tree.is_array() && tree.size() == 2 && tree[0].is_string() && tree[1].is_string();
  if (!names) return std::nullopt;
  return Metric::Value(std::array{models::Name(tree[0].get<std::string>()),
                                  models::Name(tree[1].get<std::string>())});
}

ordered_json TreeOf(const std::vector<ExpectationResult>& expectations) {
  ordered_json list = ordered_json::array();
  for (const ExpectationResult& expectation : expectations) {
    list.push_back(
        {{"name", expectation.name},
         {"value", expectation.value ? ordered_json(*expectation.value) : ordered_json()},
         {"bound", expectation.bound},
         {"at", expectation.at},
         {"ok", expectation.ok}});
  }
  return list;
}

ordered_json TreeOf(const std::vector<Blocked>& blocked) {
  ordered_json list = ordered_json::array();
  for (const auto& [system, by] : blocked) {
    list.push_back({{"system", system},
                    {"kind", by.kind},
                    {"pair", {by.one.text(), by.other.text()}},
                    {"amount", by.amount},
                    {"unit", by.unit},
                    {"text", by.text}});
  }
  return list;
}

/// What the seed drew of a family of scenarios.
ordered_json TreeOf(const sampling::Scenario& scenario) {
  ordered_json parameters = ordered_json::object();
  for (const Value::Entry& entry : scenario.parameters) {
    double number = 0.0;
    if (entry.value.integer() != nullptr) {
      parameters[entry.key] = *entry.value.integer();
    } else if (entry.value.number(number)) {
      parameters[entry.key] = number;
    }
  }
  return {{"tries", scenario.tries},
          {"parameters", parameters},
          {"drawn_obstacles", scenario.obstacles}};
}

ordered_json TreeOf(const IntegratorStatistics& integrator) {
  return {{"steps", integrator.steps},
          {"rejected_steps", integrator.rejected_steps},
          {"derivative_calls", integrator.derivative_calls},
          {"restarts", integrator.restarts}};
}

}  // namespace

ordered_json MetricsTree(const std::optional<MotionMetricsValue>& metrics) {
  ordered_json tree = ordered_json::object();
  if (!metrics) return tree;
  for (const Metric& metric : systems::MetricsIn(*metrics)) {
    tree[std::string(metric.name)] = TreeOf(metric.value);
  }
  return tree;
}

std::optional<MotionMetricsValue> ReadMetrics(const ordered_json& tree) {
  MotionMetricsValue metrics;
  for (const auto& [key, item] : tree.get_ref<const ordered_json::object_t&>()) {
    const auto value = ValueOf(item);
    if (!value || !systems::SetMetric(metrics, {key, *value})) return std::nullopt;
  }
  if (tree.empty()) return std::nullopt;
  return metrics;
}

std::string MetricsJson(const std::optional<MotionMetricsValue>& metrics) {
  return oca::internal::JsonText(MetricsTree(metrics));
}

std::string ExpectationsJson(const RunResult& result) {
  return oca::internal::JsonText(TreeOf(result.expectations));
}

std::string ResultJson(const loading::LoadedDiagram& loaded, const RunResult& result) {
  ordered_json json{{"name", loaded.name},
                    {"file", loaded.file},
                    {"seed", loaded.simulator.seed},
                    {"duration", result.duration},
                    {"steps", result.statistics.steps},
                    {"wall_seconds", result.wall_seconds},
                    {"realtime_factor", result.duration / result.wall_seconds},
                    {"metrics", MetricsTree(result.metrics)},
                    {"not_seen", BlindSpots(loaded)},
                    {"blocked", TreeOf(result.blocked)},
                    {"expectations", TreeOf(result.expectations)},
                    {"integrator", TreeOf(result.statistics.integrator)},
                    {"interrupted", result.interrupted}};
  if (loaded.scenario.tries > 0) json["scenario"] = TreeOf(loaded.scenario);
  if (result.paced) {
    json["overruns"] = result.statistics.overruns;
    json["worst_overrun"] = result.statistics.worst_overrun;
  }
  for (const SystemTime& time : result.profile) {
    json["profile"].push_back({{"system", time.system},
                               {"calls", time.calls},
                               {"seconds", time.seconds},
                               {"slowest", time.slowest},
                               {"times", time.times}});
  }
  if (result.failure) json["failure"] = result.failure->message;
  return oca::internal::JsonText(json, 2);
}

}  // namespace oca::runs
