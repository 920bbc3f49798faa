// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// First-order lag on the delta that calms the loop through the robot, tick by tick:
///
///     relaxed_delta = x + min(1, period / relaxation_time) (delta - x),   x_k = relaxed_delta
///
/// starting at x = 0. The longer of the parameter and the input `relaxation_time` counts. If
/// `held` is connected it takes the place of x: what a limiter behind left of the last delta, from
/// which the way goes on, so that a large delta cannot run away behind the limiter. The output has
/// feedthrough: whoever updates at the same tick reads the value of this tick, without a delay.
/// (Between two ticks the output thus shows where the next tick would go.) `relaxation_time` 0
/// passes the delta through.
///
/// in    delta            n  u
/// in    relaxation_time  1  s    optional, as a LoopGain tells it
/// in    held             n  u    optional
/// out   relaxed_delta  n  u
/// state x              n  u    the relaxed delta of the last tick
/// throws ConfigError if relaxation_time is negative or period is not positive
/// source docs/theory.md, Loop gain and relaxation: stable for
///        relaxation_time > period (1 + g) / 2, g the loop's gain
class DeltaRelaxation final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "first-order lag on the delta, against chatter",
      "relaxed_delta = x + min(1, period / relaxation_time) (delta - x); x = last relaxed_delta",
      ""};
  struct Params {
    double relaxation_time{0.0};
    Period period{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.relaxation_time = 0.4, .period = Period(1, 100)}; }

  explicit DeltaRelaxation(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const DiscreteState<Vector> x_;
  using OptionalVector = std::optional<VectorView>;
  void CalcRelaxed(VectorView delta_value, OptionalVector time, OptionalVector left, VectorView x,
                   MutableVectorView relaxed) const;
  void Update(VectorView relaxed, MutableVectorView next) const;

 public:
  const Input<Vector> delta;
  const OptionalInput<Vector> relaxation_time;
  const OptionalInput<Vector> held;
  const Output<Vector> relaxed_delta;
};

}  // namespace oca::systems
