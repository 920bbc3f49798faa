// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/summary_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "oca/diagrams/sweep/campaign_tree.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::sweep {
namespace {

using nlohmann::ordered_json;

ordered_json TreeOf(const Share& share) {
  if (share.of == 0) return {};
  const auto [low, high] = share.interval();
  return {{"count", share.count},
          {"of", share.of},
          {"share", static_cast<double>(share.count) / static_cast<double>(share.of)},
          {"low", low},
          {"high", high}};
}

ordered_json TreeOf(const Spread& spread) {
  if (spread.count == 0) return {};
  return {{"count", spread.count},      {"median", spread.median},
          {"low", spread.interval.low}, {"high", spread.interval.high},
          {"worst", spread.worst},      {"worst_sample", spread.worst_sample}};
}

ordered_json TreeOf(const CombinationSummary& one) {
  ordered_json set = ordered_json::object();
  for (const auto& [path, value] : one.settings) set[path] = value;
  ordered_json steps;
  if (one.steps.count() > 0) {
    steps = {{"p50", one.steps.Quantile(0.5)},
             {"p99", one.steps.Quantile(0.99)},
             {"max", one.steps.max()}};
  }
  return {{"set", set},
          {"runs", one.runs},
          {"unfinished", one.unfinished},
          {"clear", TreeOf(one.clear)},
          {"sampled_clear", TreeOf(one.sampled_clear)},
          {"arrived", TreeOf(one.arrived)},
          {"clear_and_arrived", TreeOf(one.both)},
          {"expectations_met", TreeOf(one.met)},
          {"min_distance", TreeOf(one.min_distance)},
          {"final_error", TreeOf(one.final_error)},
          {"delta_sign_changes_per_second", TreeOf(one.reversals)},
          {"total_variation_ratio", TreeOf(one.path_ratio)},
          {"time_to_goal", TreeOf(one.time_to_goal)},
          {"max_abs_delta", TreeOf(one.max_delta)},
          {"within_limits", TreeOf(one.within_limits)},
          {"limit_violations", TreeOf(one.limit_violations)},
          {"step_seconds", steps}};
}

/// The end of a path, from one of its dots, that no other setting has: `avoid`, or
/// `left.parameters.avoid` beside `right.parameters.avoid`.
std::string ShortName(const std::string& path, const Settings& settings) {
  std::size_t dot = path.rfind('.');
  while (dot != std::string::npos) {
    const bool unique = std::none_of(settings.begin(), settings.end(), [&](const auto& other) {
      return other.first != path && ("." + other.first).ends_with(path.substr(dot));
    });
    if (unique) return path.substr(dot + 1);
    dot = dot == 0 ? std::string::npos : path.rfind('.', dot - 1);
  }
  return path;
}

}  // namespace

std::string TitleOf(const Settings& settings) {
  std::string title;
  for (const auto& [path, value] : settings) {
    title += fmt::format("{}{}={}", title.empty() ? "" : " ", ShortName(path, settings), value);
  }
  return title;
}

std::string SummaryJson(const Results& results, const Summary& summary) {
  ordered_json json;
  json["campaign"] = CampaignTree(results.campaign);
  json["runs"] = results.rows.size();
  json["combinations"] = ordered_json::array();
  for (const CombinationSummary& one : summary.combinations) {
    json["combinations"].push_back(TreeOf(one));
  }
  json["failures"] = ordered_json::array();
  for (const Failure& failure : summary.failures) {
    json["failures"].push_back({{"sample", failure.sample},
                                {"combination", failure.combination},
                                {"seed", failure.seed},
                                {"why", failure.why},
                                {"command", failure.command}});
  }
  return oca::internal::JsonText(json, 2);
}

}  // namespace oca::sweep
