// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/runs/run.h"
#include "oca/framework/simulation/signal_log.h"

namespace oca::runs {

/// Keeps Vector signals of a run in memory, as matrices:
///
///     RunSeries series(loaded, {"plant.position"}, Period(1, 100));
///     Run(loaded, {.observers = {&series}});
///     const Eigen::MatrixXd q = series.log().Matrix();
class RunSeries final : public RunObserver {
 public:
  /// `signals`: `system.output`. `loaded` must outlive it.
  /// throws WiringError naming what there is if there is no such output
  RunSeries(const loading::LoadedDiagram& loaded, const std::vector<std::string>& signals,
            const Period& period);

  /// throws ConfigError if the period is not positive, WiringError if a signal is no Vector. A
  /// second run takes the place of the first.
  void Attach(Simulator& simulator, bool paced, double duration) override;
  void Finish(const RunResult& /*result*/) override {}

  /// throws ConfigError before a run.
  const SignalLog& log() const;

 private:
  std::vector<OutputHandle> outputs_;
  Period period_;
  std::optional<SignalLog> log_;
};

}  // namespace oca::runs
