// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/terminal.h"

namespace oca::tools {
namespace {

using nlohmann::ordered_json;

/// An arm that ends nearer than this to its goal has arrived, rad.
constexpr double kArrived = 0.01;

std::string Line(const char* label, const std::string& text) {
  return fmt::format("  {:<13}{}\n", label, text);
}

std::string ClearanceLine(const ordered_json& metrics, bool colour) {
  const auto& distance = metrics.value("min_distance", ordered_json());
  if (!distance.is_number()) return "";
  const auto& pair = metrics["min_distance_pair"];
  std::string where;
  if (pair.is_array()) {
    where = fmt::format(", {} to {} at {:.2f} s", pair[0].get<std::string>(),
                        pair[1].get<std::string>(), metrics["min_distance_time"].get<double>());
  }
  const double nearest = distance.get<double>();
  if (nearest > 0.0) {
    return Line("clearance",
                Good("clear", colour) + fmt::format(": nearest {:.3f} m", nearest) + where);
  }
  return Line("clearance",
              Bad("CONTACT", colour) + fmt::format(": {:.3f} m deep", -nearest) + where +
                  fmt::format("; {:.2f} s in contact", metrics.value("contact_time", 0.0)));
}

std::string GoalLine(const ordered_json& metrics, bool colour) {
  const auto& error = metrics.value("final_error", ordered_json());
  if (!error.is_number()) return "";
  const double off = error.get<double>();
  return Line("goal", off < kArrived
                          ? Good("reached", colour) + fmt::format(": {:.2g} rad off", off)
                          : Bad("NOT REACHED", colour) + fmt::format(": {:.3g} rad off", off));
}

std::string MotionLine(const ordered_json& metrics) {
  std::string text;
  const auto add = [&](const char* key, const char* pattern) {
    const auto& value = metrics.value(key, ordered_json());
    if (!value.is_number()) return;
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(pattern), value.get<double>());
  };
  add("max_abs_delta", "largest delta {:.3g} rad");
  add("total_variation_ratio", "path {:.3g} times the request's");
  add("delta_sign_changes_per_second", "{:.1f} delta reversals a second");
  std::string lines = text.empty() ? "" : Line("alteration", text);
  text.clear();
  add("max_joint_speed", "joint speed up to {:.3g} rad/s");
  add("max_joint_acceleration", "acceleration up to {:.3g} rad/s^2");
  return lines + (text.empty() ? "" : Line("motion", text));
}

std::string ExpectationLines(const diagrams::RunResult& result, bool colour) {
  std::string lines;
  for (const diagrams::ExpectationResult& expectation : result.expectations) {
    const std::string value =
        expectation.value ? fmt::format("{:.6g}", *expectation.value) : std::string("no value");
    lines += Line(&expectation == result.expectations.data() ? "expected" : "",
                  fmt::format("{} {} {} (got {})",
                              expectation.ok ? Good("met", colour) : Bad("NOT MET", colour),
                              expectation.name, expectation.bound, value));
  }
  return lines;
}

}  // namespace

std::string RunSummary(const diagrams::LoadedDiagram& loaded, const diagrams::RunResult& result,
                       bool colour) {
  const auto metrics = ordered_json::parse(result.metrics);
  std::string text = loaded.name;
  if (!loaded.description.empty()) text += Dim(": " + loaded.description, colour);
  text += '\n';
  if (!result.failure.empty()) text += Line("run", Bad("FAILED", colour) + ": " + result.failure);
  if (result.interrupted) text += Line("run", Bad("INTERRUPTED", colour));
  text += ClearanceLine(metrics, colour) + GoalLine(metrics, colour) + MotionLine(metrics) +
          ExpectationLines(result, colour);
  text += Line("time", fmt::format("{:g} s in {:.3g} s, {:.0f} times real time; {} steps",
                                   result.duration, result.wall_seconds,
                                   result.duration / result.wall_seconds, result.statistics.steps));
  return text;
}

}  // namespace oca::tools
