// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/sample_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "oca/diagrams/runs/metrics_tree.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::sweep {
namespace {

using nlohmann::ordered_json;
using oca::internal::WholeNumber;

constexpr std::array kOutcomes{"finished", "failed", "not_loaded", "timed_out", "crashed"};

constexpr std::int64_t kMostSteps = 1'000'000'000'000;  // of a class: sums stay within 64 bits

Outcome OutcomeNamed(const std::string& name) {
  const auto found = std::find(kOutcomes.begin(), kOutcomes.end(), name);
  if (found == kOutcomes.end()) throw ConfigError("unknown outcome '" + name + "'");
  return static_cast<Outcome>(found - kOutcomes.begin());
}

ConfigError NoRow(std::string_view line) {
  return ConfigError(fmt::format("got '{:.60}'; expected the line of a sample", line));
}

}  // namespace

const char* NameOf(Outcome outcome) { return kOutcomes[static_cast<std::size_t>(outcome)]; }

std::string SampleRow::Line() const {
  ordered_json settings = ordered_json::object();
  for (const auto& [path, value] : set) settings[path] = value;
  return oca::internal::JsonText<ordered_json>(
      {{"sample", sample},
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
    const ordered_json json = oca::internal::ReadJsonTree(line);
    SampleRow row;
    row.sample = WholeNumber<std::int64_t>(json.at("sample"));
    row.combination = WholeNumber<int>(json.at("combination"));
    row.seed = WholeNumber<int>(json.at("seed"));
    for (const auto& [path, value] : json.at("set").items()) row.set.emplace_back(path, value);
    row.outcome = OutcomeNamed(json.at("outcome"));
    if (!json.at("error").is_null()) row.error = json.at("error");
    row.duration = json.at("duration");
    row.steps = WholeNumber<std::int64_t>(json.at("steps"));
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
  return oca::internal::JsonText<ordered_json>({{"sample", sample},
                                                {"combination", combination},
                                                {"load_seconds", load_seconds},
                                                {"run_seconds", run_seconds},
                                                {"step_max", steps.max()},
                                                {"step_classes", classes}});
}

SampleTiming SampleTiming::FromLine(std::string_view line) {
  try {
    const ordered_json json = oca::internal::ReadJsonTree(line);
    SampleTiming timing;
    timing.sample = WholeNumber<std::int64_t>(json.at("sample"));
    timing.combination = WholeNumber<int>(json.at("combination"));
    timing.load_seconds = json.at("load_seconds");
    timing.run_seconds = json.at("run_seconds");
    for (const auto& item : json.at("step_classes")) {
      timing.steps.AddClass(WholeNumber<int>(item.at(0)), WholeNumber(item.at(1), 0, kMostSteps));
    }
    timing.steps.RaiseMax(json.at("step_max"));
    return timing;
  } catch (const ordered_json::exception&) {
    throw NoRow(line);
  }
}

}  // namespace oca::sweep
