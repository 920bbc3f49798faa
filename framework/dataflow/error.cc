// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/error.h"

#include <fmt/format.h>

#include <utility>

namespace oca {
namespace {

std::string Lines(const std::vector<WiringProblem>& problems) {
  std::string lines;
  for (const WiringProblem& problem : problems) {
    lines += (lines.empty() ? "" : "\n") + problem.ToString();
  }
  return lines;
}

}  // namespace

std::string PathIn(const std::string& diagram, const std::string& path) {
  const bool inside = !diagram.empty() && path.starts_with(diagram + ".");
  return inside ? path.substr(diagram.size() + 1) : path;
}

std::string PortPath::ToString(const std::string& diagram) const {
  return PathIn(diagram, system.empty() ? port : system + "." + port);
}

std::string WiringProblem::ToString(const std::string& diagram) const {
  std::string all;
  for (const Part& part : text) {
    const auto* const path = std::get_if<PortPath>(&part);
    all += path == nullptr ? std::get<std::string>(part) : path->ToString(diagram);
  }
  return all;
}

WiringError::WiringError(std::vector<WiringProblem> all_problems)
    : Error(Lines(all_problems)), problems(std::move(all_problems)) {}

WiringError::WiringError(const std::string& problem) : Error(problem), problems{{{problem}}} {}

SimulationError::SimulationError(std::string failed_system, std::string failed_port,
                                 double failure_time, std::string failure_reason)
    : Error(fmt::format("{}{}{} at t = {} s: {}", failed_system, failed_port.empty() ? "" : ".",
                        failed_port, failure_time, failure_reason)),
      system(std::move(failed_system)),
      port(std::move(failed_port)),
      time(failure_time),
      reason(std::move(failure_reason)) {}

}  // namespace oca
