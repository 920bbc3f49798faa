// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

enum class ServoMode { kDeadbeat, kSecondOrder };
std::span<const char* const> EnumNames(ServoMode);

/// Makes the joints follow a target.
///
/// deadbeat: at each tick t_k it samples x = measured_position(t_k); within the period
///
///     command = (position - x) / period
///
/// a velocity for an IntegratorPlant of order 1. `position` is the target for the *end* of the
/// period; if it is held between ticks, as a sampled generator and a DeltaLimiter hold it, the
/// plant is exactly there at t_k + period, without further delay.
///
/// second_order: the acceleration, continuous in time, for a plant of order 2
///
///     command = w^2 (position - measured_position) + 2 z w (velocity - measured_velocity)
///
/// with w `natural_frequency`, z `damping_ratio`.
///
/// in    position           n  u     target
///       velocity           n  u/s   target; optional, absent counts as 0; not used in deadbeat
///       measured_position  n  u
///       measured_velocity  n  u/s   required in second_order, not used in deadbeat
/// out   command            n  u/s (deadbeat), u/s^2 (second_order)
/// state x                  n  u     deadbeat only; measured_position at the last tick, and at the
///                                   start before the first one
/// throws ConfigError if deadbeat has no positive period, natural_frequency is not positive or
///        damping_ratio negative
/// source docs/theory.md, Servo and plant; Franklin, Powell, Emami-Naeini, Feedback Control of
///        Dynamic Systems, section 3.3 (second order)
class JointServo final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "joint controller: deadbeat velocity, or second-order acceleration",
      "deadbeat: command = (position - measured_position at the tick) / period; second_order: "
      "command = w^2 (position - measured_position) + 2 z w (velocity - measured_velocity)",
      "Franklin, Powell, Emami-Naeini, Feedback Control of Dynamic Systems, section 3.3"};
  struct Params {
    ServoMode mode{ServoMode::kDeadbeat};
    Period period{};
    PerComponent natural_frequency{20.0};
    PerComponent damping_ratio{1.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  explicit JointServo(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const DiscreteState<Vector> x_;  ///< in deadbeat

  bool deadbeat() const { return params_.mode == ServoMode::kDeadbeat; }
  OptionalInput<Vector> DeclareMeasuredVelocity();
  Output<Vector> DeclareCommand();
  void CalcDeadbeat(VectorView target, VectorView x, MutableVectorView out) const;
  void CalcSecondOrder(VectorView target, std::optional<VectorView> target_velocity, VectorView q,
                       std::optional<VectorView> v, MutableVectorView out) const;
  void Sample(VectorView q, MutableVectorView next) const;

 public:
  const Input<Vector> position;
  const OptionalInput<Vector> velocity;
  const Input<Vector> measured_position;
  const OptionalInput<Vector> measured_velocity;
  const Output<Vector> command;
};

}  // namespace oca::systems
