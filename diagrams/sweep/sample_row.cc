// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/sample_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "oca/diagrams/runs/metrics_tree.h"
#include "oca/framework/dataflow/error.h"

namespace oca::sweep {
namespace {

using nlohmann::ordered_json;

constexpr std::array kOutcomes{"finished", "failed", "not_loaded", "timed_out", "crashed"};

Outcome OutcomeNamed(const std::string& name) {
  const auto found = std::find(kOutcomes.begin(), kOutcomes.end(), name);
  if (found == kOutcomes.end()) throw ConfigError("unknown outcome '" + name + "'");
  return static_cast<Outcome>(found - kOutcomes.begin());
}

ConfigError NoRow(std::string_view line) {
  return ConfigError(fmt::format("got '{:.60}'; expected the line of a sample", line));
}

/// What foreign text holds instead of UTF-8 must not stop a campaign.
std::string Dump(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

const char* NameOf(Outcome outcome) { return kOutcomes[static_cast<std::size_t>(outcome)]; }

std::string SampleRow::Line() const {
  ordered_json settings = ordered_json::object();
  for (const auto& [path, value] : set) settings[path] = value;
  return Dump({{"sample", sample},
               {"combination", combination},
               {"seed", seed},
               {"set", settings},
               {"outcome", NameOf(outcome)},
               {"error", error.empty() ? ordered_json() : ordered_json(error)},
               {"duration", duration},
               {"steps", steps},
               {"metrics", runs::MetricsTree(metrics)},
               {"unmet", unmet}});
}

SampleRow SampleRow::FromLine(std::string_view line) {
  try {
    const ordered_json json = ordered_json::parse(line);
    SampleRow row;
    row.sample = json.at("sample");
    row.combination = json.at("combination");
    row.seed = json.at("seed");
    for (const auto& [path, value] : json.at("set").items()) row.set.emplace_back(path, value);
    row.outcome = OutcomeNamed(json.at("outcome"));
    if (!json.at("error").is_null()) row.error = json.at("error");
    row.duration = json.at("duration");
    row.steps = json.at("steps");
    row.metrics = runs::ReadMetrics(json.at("metrics"));
    if (!row.metrics && !json.at("metrics").empty()) throw NoRow(line);
    row.unmet = json.at("unmet").get<std::vector<std::string>>();
    return row;
  } catch (const ordered_json::exception&) {
    throw NoRow(line);
  }
}

std::string SampleTiming::Line() const {
  ordered_json classes = ordered_json::array();
  for (const auto& [number, count] : steps.classes()) {
    classes.push_back(ordered_json::array({number, count}));
  }
  return Dump({{"sample", sample},
               {"combination", combination},
               {"load_seconds", load_seconds},
               {"run_seconds", run_seconds},
               {"step_max", steps.max()},
               {"step_classes", classes}});
}

SampleTiming SampleTiming::FromLine(std::string_view line) {
  try {
    const ordered_json json = ordered_json::parse(line);
    SampleTiming timing;
    timing.sample = json.at("sample");
    timing.combination = json.at("combination");
    timing.load_seconds = json.at("load_seconds");
    timing.run_seconds = json.at("run_seconds");
    for (const auto& item : json.at("step_classes")) {
      timing.steps.AddClass(item.at(0).get<int>(), item.at(1).get<std::int64_t>());
    }
    timing.steps.RaiseMax(json.at("step_max"));
    return timing;
  } catch (const ordered_json::exception&) {
    throw NoRow(line);
  }
}

}  // namespace oca::sweep
