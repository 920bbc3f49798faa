// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace oca {

WiringError::WiringError(std::vector<std::string> all_problems)
    : Error(fmt::format("{}", fmt::join(all_problems, "\n"))), problems(std::move(all_problems)) {}

SimulationError::SimulationError(std::string failed_system, std::string failed_port,
                                 double failure_time, const std::string& what)
    : Error(fmt::format("{}{}{} at t = {} s: {}", failed_system, failed_port.empty() ? "" : ".",
                        failed_port, failure_time, what)),
      system(std::move(failed_system)),
      port(std::move(failed_port)),
      time(failure_time) {}

}  // namespace oca
