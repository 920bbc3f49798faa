// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/framework/dataflow/error_base.h"

namespace oca {

/// A file or a parameter is wrong.
struct ConfigError : Error {
  using Error::Error;
};

/// A diagram is wired wrongly. One line a problem; all problems of a diagram at once.
struct WiringError : Error {
  explicit WiringError(std::vector<std::string> all_problems);
  std::vector<std::string> problems;
};

/// A run failed at `time` in `system` at `port` (empty where no single port is to blame).
struct SimulationError : Error {
  SimulationError(std::string system, std::string port, double time, const std::string& what);
  std::string system;
  std::string port;
  double time;
};

}  // namespace oca
