// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/run_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/runs/blind_spots.h"
#include "oca/diagrams/runs/position_unit.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/robot_model.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

using systems::MotionMetricsValue;

/// An arm that ends nearer than this to its goal has arrived, rad or m.
constexpr double kAtGoal = 0.01;

std::string Line(const char* label, const std::string& text) {
  return fmt::format("  {:<13}{}\n", label, text);
}

/// What is known of the times between the samples.
std::string Certificate(const MotionMetricsValue& metrics, double duration) {
  if (duration == 0.0) return "; looked at once, at the start";
  const auto& certified = metrics.certified_min_distance;
  if (!certified) return "; between the samples nothing is known";
  if (*certified <= 0.0) return "; between the samples a contact is not ruled out";
  return fmt::format("; {:.3f} m or more at every time", *certified);
}

/// What stands where nothing was found within reach; `judged`: distances were asked for.
std::string NothingNear(const MotionMetricsValue& metrics, double duration, bool judged,
                        bool colour) {
  if (metrics.contact_time) {
    return Line("clearance", Good("clear", colour) +
                                 ": nothing came within reach of the distance measurement" +
                                 Certificate(metrics, duration));
  }
  if (!judged) return "";
  return Line("clearance",
              Bad("NOT KNOWN", colour) + ": there was nothing to compare the arm with");
}

std::string ClearanceLine(const MotionMetricsValue& metrics, double duration, bool judged,
                          bool colour) {
  if (!metrics.min_distance) return NothingNear(metrics, duration, judged, colour);
  const double nearest = *metrics.min_distance;
  std::string where;
  if (!metrics.min_distance_link.empty()) {
    where =
        fmt::format(", {} to {} at {:.2f} s", metrics.min_distance_link.text(),
                    metrics.min_distance_obstacle.text(), metrics.min_distance_time.value_or(0));
  }
  if (nearest > 0.0) {
    return Line("clearance", Good("clear", colour) + fmt::format(": nearest {:.3f} m", nearest) +
                                 where + Certificate(metrics, duration));
  }
  return Line("clearance",
              Bad("CONTACT", colour) + fmt::format(": {:.3f} m deep", -nearest) + where +
                  fmt::format("; {:.2f} s in contact", metrics.contact_time.value_or(0.0)));
}

/// What "clear" does not speak of.
std::string NotSeenLine(const loading::LoadedDiagram& loaded) {
  const std::vector<std::string> spots = runs::BlindSpots(loaded);
  return spots.empty() ? "" : Line("not seen", fmt::format("{}", fmt::join(spots, "; ")));
}

/// Of a joint of one of the robots, `joint` or `arm/joint`.
const char* UnitOfJoint(const loading::LoadedDiagram& loaded, models::Name joint) {
  for (const auto& named : loaded.models.all()) {
    for (const robot::Joint& each : named.second->joints()) {
      const bool is_it = each.name == joint || joint.text().ends_with("/" + each.name.text());
      if (is_it) return robot::PositionUnit(each);
    }
  }
  return "rad";
}

/// What the arm stood at.
std::string StuckAt(const MotionMetricsValue& metrics, const loading::LoadedDiagram& loaded) {
  if (metrics.stuck_link.empty()) return "nothing within reach";
  const double amount = metrics.stuck_amount.value_or(0.0);
  if (metrics.stuck_obstacle.text() == "limit") {
    return fmt::format("{} at its limit, the goal {:.3g} {} beyond it", metrics.stuck_link.text(),
                       amount, UnitOfJoint(loaded, metrics.stuck_link));
  }
  return fmt::format("nearest {} to {}, {:.3g} m", metrics.stuck_link.text(),
                     metrics.stuck_obstacle.text(), amount);
}

/// Where the arm did not get on for long, if so: at the goal it need not have ended.
std::string Standstill(const MotionMetricsValue& metrics, const loading::LoadedDiagram& loaded,
                       bool reached) {
  if (metrics.stuck_time.value_or(0.0) == 0.0) return "";
  return fmt::format("; {} for {:.3g} s, {}", reached ? "held up" : "STUCK", *metrics.stuck_time,
                     StuckAt(metrics, loaded));
}

std::string BlockedLines(const runs::RunResult& result) {
  std::string lines;
  for (const auto& [system, by] : result.blocked) lines += Line("blocked", system + ": " + by.text);
  return lines;
}

std::string GoalLine(const MotionMetricsValue& metrics, const loading::LoadedDiagram& loaded,
                     bool colour) {
  if (!metrics.final_error) return "";
  const double off = *metrics.final_error;
  const std::string unit = runs::PositionUnit(loaded);
  const std::string arrival =
      off < kAtGoal ? Good("reached", colour) + fmt::format(": {:.2g} {} off", off, unit)
                    : Bad("NOT REACHED", colour) + fmt::format(": {:.3g} {} off", off, unit);
  return Line("goal", arrival + Standstill(metrics, loaded, off < kAtGoal));
}

std::string MotionLine(const MotionMetricsValue& metrics, const std::string& unit) {
  std::string text;
  const auto add = [&text](const std::optional<double>& value, const char* pattern,
                           const std::string& of = "") {
    if (!value) return;
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(pattern), *value, of);
  };
  add(metrics.max_abs_delta, "largest delta {:.3g} {}", unit);
  add(metrics.total_variation_ratio, "path {:.3g} times the request's");
  add(metrics.delta_sign_changes_per_second, "{:.1f} delta reversals a second");
  std::string lines = text.empty() ? "" : Line("alteration", text);
  text.clear();
  add(metrics.max_joint_speed, "joint speed up to {:.3g} {}", runs::UnitOverTime(unit, "s"));
  add(metrics.max_joint_acceleration, "acceleration up to {:.3g} {}",
      runs::UnitOverTime(unit, "s^2"));
  return lines + (text.empty() ? "" : Line("motion", text));
}

std::string LimitsLine(const MotionMetricsValue& metrics, bool colour) {
  const double beyond = metrics.limit_violations.value_or(0.0);
  if (beyond == 0.0) return "";
  return Line("limits", Bad("NOT KEPT", colour) +
                            fmt::format(": {} times a joint was beyond its position, speed or "
                                        "acceleration limit at a sample",
                                        beyond));
}

std::string ExpectationLines(const runs::RunResult& result, bool colour) {
  std::string lines;
  for (const runs::ExpectationResult& expectation : result.expectations) {
    const std::string value =
        expectation.value ? fmt::format("{:.6g}", *expectation.value) : std::string("no value");
    lines += Line(&expectation == result.expectations.data() ? "expected" : "",
                  fmt::format("{} {} {} (got {})",
                              expectation.ok ? Good("met", colour) : Bad("NOT MET", colour),
                              expectation.name, expectation.bound, value));
  }
  return lines;
}

std::string PaceText(const SimulatorStatistics& statistics) {
  if (statistics.overruns == 0) return "no overruns";
  return fmt::format("{} overruns of {} steps, the worst {:.3g} ms", statistics.overruns,
                     statistics.steps, 1e3 * statistics.worst_overrun);
}

}  // namespace

std::string RunSummary(const loading::LoadedDiagram& loaded, const runs::RunResult& result,
                       bool colour) {
  std::string text = loaded.name;
  if (!loaded.description.empty()) text += Dim(": " + loaded.description, colour);
  text += '\n';
  if (result.failure) text += Line("run", Bad("FAILED", colour) + ": " + result.failure->message);
  if (result.interrupted) text += Line("run", Bad("INTERRUPTED", colour));
  const bool judged = result.metrics && runs::JudgesDistances(loaded);
  const MotionMetricsValue metrics = result.metrics.value_or(MotionMetricsValue());
  text += ClearanceLine(metrics, result.duration, judged, colour) + NotSeenLine(loaded) +
          GoalLine(metrics, loaded, colour) + BlockedLines(result) +
          MotionLine(metrics, runs::PositionUnit(loaded)) + LimitsLine(metrics, colour) +
          ExpectationLines(result, colour);
  text += Line("time", fmt::format("{:g} s in {:.3g} s, {:.0f} times real time; {} steps",
                                   result.duration, result.wall_seconds,
                                   result.duration / result.wall_seconds, result.statistics.steps));
  if (result.paced) text += Line("pace", PaceText(result.statistics));
  return text;
}

std::string ProfileTable(const runs::RunResult& result) {
  if (result.profile.empty()) return "";
  std::vector<SystemTime> rows = result.profile;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const SystemTime& a, const SystemTime& b) { return a.seconds > b.seconds; });
  double rest = result.wall_seconds;
  for (const SystemTime& row : rows) rest -= row.seconds;
  std::string text = fmt::format("  {:<28}{:>10}{:>12}{:>12}{:>8}\n", "system", "calls", "total ms",
                                 "ns a call", "share");
  for (const SystemTime& row : rows) {
    const auto calls = static_cast<double>(row.calls);
    text += fmt::format("  {:<28}{:>10}{:>12.3f}{:>12.0f}{:>7.1f}%\n", row.system, row.calls,
                        1e3 * row.seconds, row.calls == 0 ? 0.0 : 1e9 * row.seconds / calls,
                        100.0 * row.seconds / result.wall_seconds);
  }
  return text + fmt::format("  {:<28}{:>10}{:>12.3f}{:>12}{:>7.1f}%\n",
                            result.paced ? "(engine, record, waiting)" : "(engine, record)", "",
                            1e3 * rest, "", 100.0 * rest / result.wall_seconds);
}

}  // namespace oca::tools
