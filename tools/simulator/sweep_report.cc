// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <vector>

#include "oca/diagrams/sweep/summary_json.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

using sweep::CombinationSummary;
using sweep::Share;
using sweep::Spread;

constexpr std::size_t kColumnsAtOnce = 3;
constexpr std::size_t kLeastWidth = 27;  // of a column
constexpr std::size_t kFailuresShown = 10;
const char* const kNothing = "-";

std::string ShareText(const Share& share) {
  if (share.of == 0) return kNothing;
  const auto [low, high] = share.interval();
  const double percent = 100.0 * static_cast<double>(share.count) / static_cast<double>(share.of);
  return fmt::format("{:.4g} % [{:.3g}, {:.3g}]", percent, 100.0 * low, 100.0 * high);
}

std::string MedianText(const Spread& spread) {
  if (spread.count == 0) return kNothing;
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", spread.median, spread.interval.low,
                     spread.interval.high);
}

std::string WorstText(const Spread& spread) {
  if (spread.count == 0) return kNothing;
  return fmt::format("{:.3g} (sample {})", spread.worst, spread.worst_sample);
}

std::string TimesText(const sweep::StepTimes& steps) {
  if (steps.count() == 0) return kNothing;
  return fmt::format("{:.3g}, {:.3g}, {:.4g}", 1e6 * steps.Quantile(0.5),
                     1e6 * steps.Quantile(0.99), 1e6 * steps.max());
}

struct Measure {
  const char* name;
  std::function<std::string(const CombinationSummary&)> text;
};

std::vector<Measure> Measures() {
  using C = CombinationSummary;
  const auto share = [](Share C::*member) {
    return [member](const C& one) { return ShareText(one.*member); };
  };
  const auto median = [](Spread C::*member) {
    return [member](const C& one) { return MedianText(one.*member); };
  };
  const auto worst = [](Spread C::*member) {
    return [member](const C& one) { return WorstText(one.*member); };
  };
  return {{"runs", [](const C& one) { return fmt::format("{}", one.runs); }},
          {"did not finish", [](const C& one) { return fmt::format("{}", one.unfinished); }},
          {"clear at every time", share(&C::clear)},
          {"clear at control ticks", share(&C::sampled_clear)},
          {"arrived", share(&C::arrived)},
          {"clear and arrived", share(&C::both)},
          {"expectations met", share(&C::met)},
          {"least distance, m", median(&C::min_distance)},
          {"  worst", worst(&C::min_distance)},
          {"final error, rad or m", median(&C::final_error)},
          {"  worst", worst(&C::final_error)},
          {"delta reversals, 1/s", median(&C::reversals)},
          {"  worst", worst(&C::reversals)},
          {"path over request's", median(&C::path_ratio)},
          {"  worst", worst(&C::path_ratio)},
          {"time to goal, s", median(&C::time_to_goal)},
          {"  worst", worst(&C::time_to_goal)},
          {"within joint limits", share(&C::within_limits)},
          {"step p50, p99, max, us", [](const C& one) { return TimesText(one.steps); }}};
}

/// Of the measure before it.
bool IsWorst(const Measure& measure) { return std::string_view(measure.name) == "  worst"; }

/// A measure that no combination has is left out; so is one that says the same as the one before.
std::string Rows(const std::vector<CombinationSummary>& columns, std::size_t width) {
  std::string text;
  std::vector<std::string> before;
  for (const Measure& measure : Measures()) {
    std::vector<std::string> cells;
    for (const CombinationSummary& one : columns) cells.push_back(measure.text(one));
    const bool known = std::any_of(cells.begin(), cells.end(),
                                   [](const std::string& cell) { return cell != kNothing; });
    const bool repeats = std::string(measure.name) == "clear at control ticks" && cells == before;
    before = cells;
    if (!known || repeats) continue;
    text += fmt::format("  {:<24}", measure.name);
    for (const std::string& cell : cells) text += fmt::format("{:<{}} ", cell, width);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string FailureLines(const sweep::Summary& summary, bool colour) {
  std::string text;
  const std::size_t shown = std::min(kFailuresShown, summary.failures.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const sweep::Failure& failure = summary.failures[i];
    text += fmt::format("  sample {}: {}\n    {}\n", failure.sample, failure.why,
                        Dim(failure.command, colour));
  }
  if (summary.failures.size() > shown) {
    text += fmt::format("  ... and {} more: table `sample` of results.db, or --json\n",
                        summary.failures.size() - shown);
  }
  return text;
}

}  // namespace

std::string SweepMarkdown(const sweep::Results& results, const sweep::Summary& summary) {
  // What no one asks of a comparison, or each run's expectations say of it already.
  constexpr std::array<std::string_view, 3> kLeftOut{"runs", "clear at control ticks",
                                                     "expectations met"};
  std::string header = "| |", rule = "|---|";
  std::vector<std::string> lines;
  for (const CombinationSummary& one : summary.combinations) {
    const std::string title = sweep::TitleOf(one.settings);
    lines.push_back(fmt::format("| {} |", title.empty() ? results.campaign.name : title));
  }
  const std::vector<Measure> measures = Measures();
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const std::string_view name = measures[m].name;
    std::vector<std::string> cells;
    for (const CombinationSummary& one : summary.combinations) {
      cells.push_back(measures[m].text(one));
    }
    const bool nothing = std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
      return cell == kNothing || cell == "0";
    });
    if (nothing || std::count(kLeftOut.begin(), kLeftOut.end(), name) > 0) continue;
    const bool has_worst = m + 1 < measures.size() && IsWorst(measures[m + 1]);
    if (IsWorst(measures[m])) continue;
    header += fmt::format(" {}{} |", name, has_worst ? "; worst" : "");
    rule += "---|";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      lines[i] += fmt::format(" {}", cells[i]);
      if (has_worst) lines[i] += "; " + measures[m + 1].text(summary.combinations[i]);
      lines[i] += " |";
    }
  }
  std::string text = header + '\n' + rule + '\n';
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

std::string SweepTable(const sweep::Results& results, const sweep::Summary& summary, bool colour) {
  const sweep::Campaign& campaign = results.campaign;
  std::string text =
      fmt::format("{}: {} samples, seed {}", campaign.name, campaign.samples, campaign.seed);
  text += Dim("; in brackets 95 % confidence", colour) + '\n';
  const auto& all = summary.combinations;
  for (std::size_t first = 0; first < all.size(); first += kColumnsAtOnce) {
    const std::size_t count = std::min(kColumnsAtOnce, all.size() - first);
    const std::vector<CombinationSummary> columns(
        all.begin() + static_cast<std::ptrdiff_t>(first),
        all.begin() + static_cast<std::ptrdiff_t>(first + count));
    std::size_t width = kLeastWidth;
    if (all.size() > 1) {
      for (const CombinationSummary& one : columns) {
        width = std::max(width, sweep::TitleOf(one.settings).size());
      }
      text += fmt::format("  {:<24}", "");
      for (const CombinationSummary& one : columns) {
        text += fmt::format("{:<{}} ", sweep::TitleOf(one.settings), width);
      }
      text.erase(text.find_last_not_of(' ') + 1);
      text += '\n';
    }
    text += Rows(columns, width);
  }
  if (summary.failures.empty()) return text;
  text += fmt::format("{} of {} runs not clear, not arrived, not as expected or not finished:\n",
                      summary.failures.size(), results.rows.size());
  return text + FailureLines(summary, colour);
}

}  // namespace oca::tools
