// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace oca::sweep {
namespace {

using systems::MotionMetricsValue;

std::optional<bool> And(const std::optional<bool>& a, const std::optional<bool>& b) {
  if (!a || !b) return std::nullopt;
  return *a && *b;
}

void Count(const std::optional<bool>& one, Share& share) {
  if (!one) return;
  ++share.of;
  share.count += *one ? 1 : 0;
}

/// The values of one metric, sample by sample.
class Collected {
 public:
  void Add(std::optional<double> value, std::int64_t sample) {
    if (value) all_.emplace_back(*value, sample);
  }
  Spread Make(bool least_is_worst) {
    Spread spread;
    if (all_.empty()) return spread;
    std::stable_sort(all_.begin(), all_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<double> sorted;
    for (const auto& [value, sample] : all_) sorted.push_back(value);
    spread.count = std::ssize(sorted);
    spread.median = Quantile(sorted, 0.5);
    spread.interval = MedianInterval(sorted);
    std::tie(spread.worst, spread.worst_sample) = least_is_worst ? all_.front() : all_.back();
    return spread;
  }

 private:
  std::vector<std::pair<double, std::int64_t>> all_;
};

/// One combination while its runs come in.
struct Collection {
  Collected min_distance, final_error, reversals, path_ratio, time_to_goal, max_delta, violations;

  void Add(const SampleRow& row, CombinationSummary& summary) {
    if (!row.metrics) return;
    const MotionMetricsValue& metrics = *row.metrics;
    min_distance.Add(metrics.min_distance, row.sample);
    final_error.Add(metrics.final_error, row.sample);
    reversals.Add(metrics.delta_sign_changes_per_second, row.sample);
    path_ratio.Add(metrics.total_variation_ratio, row.sample);
    time_to_goal.Add(metrics.time_to_goal, row.sample);
    max_delta.Add(metrics.max_abs_delta, row.sample);
    violations.Add(metrics.limit_violations, row.sample);
    if (metrics.limit_violations) Count(*metrics.limit_violations == 0.0, summary.within_limits);
  }

  void Finish(CombinationSummary& summary) {
    summary.min_distance = min_distance.Make(true);
    summary.final_error = final_error.Make(false);
    summary.reversals = reversals.Make(false);
    summary.path_ratio = path_ratio.Make(false);
    summary.time_to_goal = time_to_goal.Make(false);
    summary.max_delta = max_delta.Make(false);
    summary.limit_violations = violations.Make(false);
  }
};

}  // namespace

Verdict Judge(const SampleRow& row, double arrival) {
  if (row.outcome != Outcome::kFinished) return {false, false, false, false, false};
  const MotionMetricsValue metrics = row.metrics.value_or(MotionMetricsValue());
  Verdict judgement;
  judgement.met = row.unmet.empty();
  if (metrics.min_distance) {
    judgement.sampled_clear = *metrics.min_distance > 0.0;
  } else if (metrics.contact_time) {
    judgement.sampled_clear = true;  // something looked, and nothing came within its reach
  }
  const auto& certified = metrics.certified_min_distance;
  judgement.clear = certified ? *certified > 0.0 : judgement.sampled_clear;
  if (metrics.final_error) judgement.arrived = *metrics.final_error <= arrival;
  judgement.both = And(judgement.clear, judgement.arrived);
  return judgement;
}

std::string FailureOf(const SampleRow& row, double arrival) {
  if (row.outcome != Outcome::kFinished) {
    return std::string(NameOf(row.outcome)) + (row.error.empty() ? "" : ": " + row.error);
  }
  const Verdict judgement = Judge(row, arrival);
  const MotionMetricsValue metrics = row.metrics.value_or(MotionMetricsValue());
  std::vector<std::string> whys;
  if (judgement.sampled_clear == false) {
    whys.push_back(fmt::format("contact, {:.3g} m", *metrics.min_distance));
  } else if (judgement.clear == false) {
    whys.push_back(fmt::format("contact not ruled out between ticks, {:.3g} m at them",
                               metrics.min_distance.value_or(0.0)));
  }
  if (judgement.arrived == false) {
    whys.push_back(fmt::format("not arrived, {:.3g} off", *metrics.final_error));
  }
  for (const std::string& unmet : row.unmet) whys.push_back("not met: " + unmet);
  std::string text;
  for (const std::string& why : whys) text += (text.empty() ? "" : "; ") + why;
  return text;
}

Summary Summarize(const Results& results) {
  const Campaign& campaign = results.campaign;
  const std::vector<Settings> combinations = campaign.Combinations();
  Summary summary;
  for (const Settings& settings : combinations) {
    summary.combinations.emplace_back().settings = settings;
  }
  std::vector<Collection> collections(combinations.size());
  for (const SampleRow& row : results.rows) {
    const auto number = static_cast<std::size_t>(row.combination);
    CombinationSummary& one = summary.combinations.at(number);
    const Verdict judgement = Judge(row, campaign.arrival);
    ++one.runs;
    Count(judgement.clear, one.clear);
    Count(judgement.sampled_clear, one.sampled_clear);
    Count(judgement.arrived, one.arrived);
    Count(judgement.both, one.both);
    Count(judgement.met, one.met);
    if (row.outcome == Outcome::kFinished) {
      collections[number].Add(row, one);
      summary.unmet += row.unmet.empty() ? 0 : 1;
    } else {
      ++one.unfinished;
      ++summary.unfinished;
    }
    const std::string why = FailureOf(row, campaign.arrival);
    if (why.empty()) continue;
    summary.failures.push_back({row.sample, row.combination, row.seed, why,
                                campaign.CommandOf(row.seed, combinations[number])});
  }
  for (const SampleTiming& timing : results.timings) {
    summary.combinations.at(static_cast<std::size_t>(timing.combination)).steps.Add(timing.steps);
  }
  for (std::size_t i = 0; i < collections.size(); ++i) {
    collections[i].Finish(summary.combinations[i]);
  }
  return summary;
}

}  // namespace oca::sweep
