// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run_result.h"

namespace oca::runs {

/// The metrics of all judges as one; none without a judge.
std::optional<systems::MotionMetricsValue> MetricsOfAll(const std::vector<Judgement>& judgements);

/// Looks at what a file expects, while its run goes on.
class ExpectationCheck {
 public:
  /// `duration` s of the run. throws ConfigError if the file looks at something after the end.
  ExpectationCheck(const loading::LoadedDiagram& loaded, double duration);

  /// When it has to look, ascending, s; the last is the end of the run.
  const std::vector<double>& stops() const { return stops_; }
  /// Looks at those of one stop. A min_distance without a value, for nothing came within reach, is
  /// at least what certified_min_distance proves; `bound` then says so.
  void CheckAt(double stop, const loading::LoadedDiagram& loaded, const Context& context);
  /// How they turned out, with what a file expects without saying so: it is listed if it was not
  /// met, unless an expectation of the file allows a contact or says already that there was one.
  std::vector<ExpectationResult> Finish(const loading::LoadedDiagram& loaded,
                                        const std::optional<systems::MotionMetricsValue>& metrics,
                                        double end);

 private:
  std::vector<double> stops_;
  std::vector<ExpectationResult> results_;
};

}  // namespace oca::runs
