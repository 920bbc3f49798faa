// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/simulation/integration_method.h"

namespace oca {

/// Advances a Context to the next zero crossing of a witness function.
///
/// A witness crosses where it, having been nonzero, reaches or changes sign. Each step of the
/// integrator is looked at in several places of its interpolant, the minima of |w| between them
/// included, so that two crossings in one step are seen. Crossings are bracketed to less than
/// 1e-12 s (relative beyond 1 s); the earliest ends the step, with all others no further from it.
///
/// What has just crossed is at rest: right after, as long as it is no larger than where the bracket
/// ended, it counts as zero, so that its own rounding is no second crossing.
class WitnessLocator {
 public:
  WitnessLocator(const Schedule& schedule, const IntegratorOptions& options);

  /// Integrates from the context's time to `to`, or to the first crossing, whose witnesses are then
  /// pending; true if there was one. `integrator` may be nullptr if nothing moves but the time.
  /// throws SimulationError if a witness fails, needs too many steps, or crosses ever faster
  /// (Zeno).
  bool Advance(Context& context, IntegrationMethod* integrator, double to);

 private:
  struct Look {
    double t;
    double w;
  };

  void Start(Context& context);
  bool FindCrossings(Context& context, double to);
  double FirstCrossing(Context& context, int witness);
  double Scan(Context& context, int witness, Look left, Look right, int looks);
  double Crossing(Context& context, int witness, Look left, Look right, int depth);
  double CrossingAndBack(Context& context, int witness, Look left, Look right, int depth);
  double CrossingFromRest(Context& context, int witness, Look start, Look next);
  double CrossingInDip(Context& context, int witness, Look left, Look right);
  double CrossingAfter(Context& context, int witness, Look end);
  Look Minimum(Context& context, int witness, Look left, Look middle, Look right);
  std::pair<Look, Look> Bracket(Context& context, int witness, Look left, Look right);
  Look LookAt(Context& context, int witness, double t);
  void MoveTo(Context& context, double t);
  double Value(Context& context, int witness) const;
  void Trigger(Context& context, int witness);
  void CheckSteps(const Context& context, int steps) const;
  void CheckZeno(const Context& context, int witness) const;
  /// From the last crossing to `t`, s; 0 for the first.
  static double IntervalTo(const Schedule::WitnessState& state, double t);
  bool Fires(int witness, double before, double after) const;

  const Schedule& schedule_;
  const int max_steps_;
  IntegrationMethod* integrator_{nullptr};
  double begin_{0.0}, end_{0.0};        // s; of the present step
  std::vector<double> end_state_, at_;  // x at the end of the step; x at a look
  std::vector<double> start_value_;     // of each witness, 0 at rest
  std::vector<double> end_value_;
  std::vector<double> scale_;     // the largest |w| seen in the step
  std::vector<double> crossing_;  // s; infinity for none
};

}  // namespace oca
