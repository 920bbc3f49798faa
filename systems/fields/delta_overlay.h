// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Adds the delta of the avoidance to a requested trajectory, and its rate to the velocity:
///
///     position = request + delta
///     velocity = request_velocity + (delta - x) / period,   x the delta before the last tick
///
/// The request itself stays untouched, so the arm returns to it. `delta` should be held between
/// ticks, as a DeltaLimiter holds it; the rate is then its mean rate over the last control period.
/// If not `enabled`, the request passes.
///
/// in    request           n  u
///       request_velocity  n  u/s   optional; absent counts as 0
///       delta             n  u
/// out   position       n  u
///       velocity       n  u/s
///       applied_delta  n  u    what was added: delta, or 0 if not enabled
/// state x         n  u     delta before the last tick, starting at 0
/// throws ConfigError if period is negative
/// source report section 3.4 (which adds to positions only); docs/theory.md
class DeltaOverlay final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "adds the delta and its rate to a trajectory",
      "position = request + delta; velocity = request_velocity + (delta - previous delta) / period",
      "Jain, Sixt, Exner 2016, section 3.4"};
  struct Params {
    Period period{};
    bool enabled{true};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  explicit DeltaOverlay(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const DiscreteState<Vector> x_;
  void CalcPosition(VectorView request_value, VectorView delta_value, MutableVectorView sum) const;
  void CalcVelocity(std::optional<VectorView> request_rate, VectorView delta_value, VectorView x,
                    MutableVectorView sum) const;
  void CalcApplied(VectorView delta_value, MutableVectorView applied) const;
  void Update(VectorView delta_value, MutableVectorView next) const;

 public:
  const Input<Vector> request;
  const OptionalInput<Vector> request_velocity;
  const Input<Vector> delta;
  const Output<Vector> position;
  const Output<Vector> velocity;
  const Output<Vector> applied_delta;
};

}  // namespace oca::systems
