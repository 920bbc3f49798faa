// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "oca/framework/dataflow/integrator_options.h"

namespace oca {

class Context;
class Schedule;

struct IntegratorStatistics {
  std::int64_t steps{0};
  std::int64_t rejected_steps{0};
  std::int64_t derivative_calls{0};
  std::int64_t restarts{0};
};

/// Advances the continuous state of a Context between two events.
class IntegrationMethod {
 public:
  virtual ~IntegrationMethod() = default;
  /// Forgets the past: the right-hand side changed (`jumped` false) or the state jumped.
  virtual void Restart(Context& context, bool jumped) = 0;
  /// Integrates the context's continuous state from its time to `to`.
  /// throws SimulationError.
  virtual void IntegrateTo(Context& context, double to) = 0;
  /// Makes one internal step from the context's time, no further than `to`, where it ends exactly
  /// if it comes so far.
  /// throws SimulationError.
  virtual void Step(Context& context, double to) = 0;
  /// The state at `time` within the last Step, interpolated. May call for derivatives, which moves
  /// the context's time and state.
  /// throws SimulationError.
  virtual void Interpolate(Context& context, double time, double* state) = 0;
  const IntegratorStatistics& statistics() const { return statistics_; }

 protected:
  IntegratorStatistics statistics_;
};

/// throws ConfigError if an option is out of bounds.
std::unique_ptr<IntegrationMethod> MakeIntegrationMethod(const Schedule& schedule,
                                                         const IntegratorOptions& options);

}  // namespace oca
