// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/run_series.h"

#include "oca/framework/dataflow/error.h"

namespace oca::runs {

RunSeries::RunSeries(const loading::LoadedDiagram& loaded, const std::vector<std::string>& signals,
                     const Period& period)
    : period_(period) {
  for (const std::string& signal : signals) {
    outputs_.push_back(loaded.diagram->FindOutput(signal));
  }
}

void RunSeries::Attach(Simulator& simulator, bool /*paced*/, double /*duration*/) {
  log_.emplace(simulator, outputs_, period_);
}

const SignalLog& RunSeries::log() const {
  if (!log_) throw ConfigError("series: run; got none yet; expected one that observes with it");
  return *log_;
}

}  // namespace oca::runs
