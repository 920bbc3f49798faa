// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/log.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::runs {

struct RunResult;

/// Looks on a run from its beginning to its end, as a recorder does.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Before the simulator is initialized, so that publishes can be added. `paced`: by the wall
  /// clock, which nobody may hold up. `duration` s.
  virtual void Attach(Simulator& simulator, bool paced, double duration) = 0;
  /// After the last step; a run that failed ends in its last state before that.
  virtual void Finish(const RunResult& result) = 0;
};

struct RunOptions {
  std::optional<double> duration{};         ///< s; instead of the file's
  std::filesystem::path csv_folder{};       ///< empty: nothing is recorded
  std::optional<double> realtime_factor{};  ///< instead of the file's; 0 as fast as possible
  bool profile{false};                      ///< measure what each system takes
  Log* log{nullptr};                        ///< receives what systems log
  /// Called after each step with the time; returning false interrupts the run.
  std::function<bool(double time)> progress{};
  /// Must outlive the run.
  std::vector<RunObserver*> observers{};
};

/// How an expectation turned out.
struct ExpectationResult {
  std::string name;
  std::optional<double> value;  ///< empty: the metric has no source, or the run ended before
  std::string bound;            ///< as in `>= 0.02`
  double at;                    ///< s
  bool ok;
};

struct RunResult {
  double duration;  ///< s, that was simulated
  SimulatorStatistics statistics;
  double wall_seconds;
  std::string metrics;  ///< JSON object; `{}` without a MotionMetrics
  std::vector<ExpectationResult> expectations;
  bool paced{false};                ///< by the wall clock
  std::vector<SystemTime> profile;  ///< if it was asked for
  bool interrupted{false};
  std::string failure;  ///< why the run ended early; empty if it did not

  bool ExpectationsMet() const;
};

/// What the diagram's MotionMetrics say by now, all arms as one: the nearest approach and the
/// largest of everything else. A JSON object; `{}` without a MotionMetrics, or if it cannot be
/// computed.
std::string MetricsOf(const loading::LoadedDiagram& loaded, const Context& context);
/// The same of some of them.
std::string MetricsOf(const files::NamedOutputs& judges, const Context& context);

/// Runs a loaded diagram from time 0. A contact that no expectation allows is an expectation that
/// was not met: `min_distance > 0` joins the others. A calculation that fails ends the run with
/// `failure`; what was recorded and measured up to there is kept. throws ConfigError if the
/// realtime factor is negative or not finite, if a record cannot be written or the simulator's
/// options are wrong.
RunResult Run(const loading::LoadedDiagram& loaded, const RunOptions& options);

}  // namespace oca::runs
