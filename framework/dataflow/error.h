// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "oca/framework/dataflow/error_base.h"

namespace oca {

/// A file or a parameter is wrong.
struct ConfigError : Error {
  using Error::Error;
};

/// A path from the root, as seen from a nested diagram if it leads into that: `left.plant` from
/// `left` is `plant`.
std::string PathIn(const std::string& diagram, const std::string& path);

/// A port or a state of a system.
struct PortPath {
  std::string system;  ///< its path from the root, `left.plant`; empty: a port of the root
  std::string port;    ///< `position`
  /// `left.plant.position`; `plant.position` as seen from the nested diagram `left`.
  std::string ToString(const std::string& diagram = "") const;
};

/// What is wrong with the wiring of a diagram, and which ports it is about.
struct WiringProblem {
  using Part = std::variant<std::string, PortPath>;
  std::vector<Part> text;          ///< words, and ports where they are named
  std::vector<PortPath> inputs{};  ///< what drives these is wrong; those of a loop, in its order
  std::string system{};            ///< path of the one that it is of, if it is of one alone
  /// The text as a whole, with ports named as seen from the nested diagram with this path.
  std::string ToString(const std::string& diagram = "") const;
};

/// A diagram is wired wrongly. One line a problem; all problems of a diagram at once.
struct WiringError : Error {
  explicit WiringError(std::vector<WiringProblem> all_problems);
  /// One problem, of no port of a diagram.
  explicit WiringError(const std::string& problem);
  std::vector<WiringProblem> problems;
};

/// A run failed at `time` in `system` at `port` (empty where no single port is to blame).
struct SimulationError : Error {
  SimulationError(std::string system, std::string port, double time, std::string reason);
  std::string system;
  std::string port;
  double time;
  std::string reason;
};

}  // namespace oca
