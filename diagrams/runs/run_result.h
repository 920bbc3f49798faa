// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/profile.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/systems/signals/motion_metrics_value.h"
#include "oca/systems/signals/roles.h"

namespace oca::runs {

/// How an expectation turned out.
struct ExpectationResult {
  std::string name;
  std::optional<double> value;  ///< empty: the metric has no source, or the run ended before
  std::string bound;            ///< as in `>= 0.02`
  double at;                    ///< s
  bool ok;
};

/// Why a run ended early, or an output of it is not whole.
struct RunFailure {
  std::string system;   ///< path; empty: of no system
  std::string port;     ///< empty: no single port is to blame
  double time;          ///< s
  std::string message;  ///< all of it, as a person reads it
};

/// What one system that judges says of the run.
struct Judgement {
  std::string judge;  ///< its path
  systems::MotionMetricsValue metrics;
};

/// What keeps a robot from its goal, as one system says.
struct Blocked {
  std::string system;  ///< its path
  systems::Obstruction by;
};

/// What came of a run.
struct RunResult {
  double duration{0.0};  ///< s, that was simulated
  SimulatorStatistics statistics{};
  double wall_seconds{0.0};
  /// All judges as one (systems::WorstOf); none: nobody judges, or what failed the run fails here.
  std::optional<systems::MotionMetricsValue> metrics{};
  std::vector<Judgement> judgements{};  ///< one a judge, as far as they can be computed
  std::vector<Blocked> blocked{};       ///< at the end; by systems that know
  std::vector<ExpectationResult> expectations{};
  bool paced{false};                  ///< by the wall clock
  std::vector<SystemTime> profile{};  ///< if it was asked for
  bool interrupted{false};
  std::optional<RunFailure> failure{};

  bool ExpectationsMet() const;
};

}  // namespace oca::runs
