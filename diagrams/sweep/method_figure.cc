// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/method_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "oca/diagrams/sweep/merge.h"
#include "oca/diagrams/sweep/summary_json.h"
#include "oca/framework/dataflow/error.h"

namespace oca::sweep {
namespace {

using record::PlotCurve;
using record::PlotPanel;
using systems::MotionMetricsValue;

double CountFinished(const Results& results, int combination) {
  return static_cast<double>(
      std::count_if(results.rows.begin(), results.rows.end(), [combination](const SampleRow& row) {
        return row.combination == combination && row.outcome == Outcome::kFinished;
      }));
}

/// A metric of the runs of a combination that finished and have it, ascending.
std::vector<double> Sorted(const Results& results, int combination,
                           std::optional<double> systems::MotionMetricsValue::*metric) {
  std::vector<double> values;
  for (const SampleRow& row : results.rows) {
    if (row.combination != combination || row.outcome != Outcome::kFinished) continue;
    if (!row.metrics) continue;
    if (const auto& value = *row.metrics.*metric) values.push_back(*value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

void Step(PlotCurve& curve, double x, double y) {
  curve.x.push_back(x);
  curve.y.push_back(y);
}

/// Percent of `all` runs whose value is at most x, as a staircase up to `end`.
PlotCurve AtMost(const std::vector<double>& values, double all, double end) {
  PlotCurve curve;
  double share = 0.0;
  for (const double value : values) {
    Step(curve, value, share);
    share += 100.0 / all;
    Step(curve, value, share);
  }
  if (!values.empty()) Step(curve, end, share);
  return curve;
}

/// Percent of `all` runs whose value is at least x; of `finished` ones those without a value were
/// always far.
PlotCurve AtLeast(const std::vector<double>& values, double all, double finished, double start) {
  PlotCurve curve;
  double share = 100.0 * finished / all;
  if (!values.empty()) Step(curve, std::min(start, values.front()), share);
  for (const double value : values) {
    Step(curve, value, share);
    share -= 100.0 / all;
    Step(curve, value, share);
  }
  return curve;
}

void AddPanels(const Results& results, std::vector<PlotPanel>& panels) {
  const std::string& name = results.campaign.name;
  const auto all = static_cast<double>(results.campaign.samples);
  PlotPanel near{name + ": came no nearer than", "distance [m]", "runs [%]"};
  PlotPanel late{name + ": at the goal after", "time [s]", "runs [%]"};
  const auto combinations = results.campaign.Combinations();
  std::vector<std::vector<double>> times;
  double end = 0.0;
  for (int i = 0; i < static_cast<int>(combinations.size()); ++i) {
    times.push_back(Sorted(results, i, &MotionMetricsValue::time_to_goal));
    if (!times.back().empty()) end = std::max(end, times.back().back());
  }
  for (int i = 0; i < static_cast<int>(combinations.size()); ++i) {
    const std::string label = combinations[i].empty() ? name : TitleOf(combinations[i]);
    PlotCurve distance = AtLeast(Sorted(results, i, &MotionMetricsValue::min_distance), all,
                                 CountFinished(results, i), 0.0);
    PlotCurve arrival = AtMost(times[i], all, end);
    distance.label = arrival.label = label;
    distance.colour = arrival.colour = i;
    // More than eight colours nobody tells apart: the rest is dashed.
    distance.run = arrival.run = i / 8;
    if (!distance.x.empty()) near.curves.push_back(std::move(distance));
    if (!arrival.x.empty()) late.curves.push_back(std::move(arrival));
  }
  for (PlotPanel* panel : {&near, &late}) {
    panel->y_min = 0.0;
    panel->y_max = 100.0;
    if (!panel->curves.empty()) panels.push_back(std::move(*panel));
  }
}

}  // namespace

std::vector<PlotPanel> MethodPanels(const std::vector<std::string>& folders) {
  std::vector<PlotPanel> panels;
  for (const std::string& folder : folders) {
    const std::size_t before = panels.size();
    AddPanels(MergeShards(folder), panels);
    if (panels.size() == before) {
      throw ConfigError(
          fmt::format("{}: got no finished run with a distance or a time to the goal", folder));
    }
  }
  return panels;
}

}  // namespace oca::sweep
