// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

/// Lets a method that chooses joint velocities stand where others tell a delta: it says which
/// velocity follows the request, and turns the one that was chosen into a delta.
///
///     wish = velocity + acceleration period / 2 + position_gain (position - s), braked for arrival
///     delta = c + u period - position
///
/// s is `command`, or else c + u period. The state is the command c of this tick and the velocity u
/// chosen for it; the arm is to be at c + u period at the next one, so that a DeltaOverlay sends it
/// there whatever the request does meanwhile. At a tick `position` is read as the request for this
/// very time. The way back to the request is slowed so that half the acceleration limit stops it
/// there. `delta` does not depend on `chosen` but through the state: the method between `wish` and
/// `chosen` closes no algebraic loop.
///
/// in    position           n  u       requested, as an overlay adds delta to it
///       velocity           n  u/s     requested; optional, absent counts as 0
///       acceleration       n  u/s^2   requested; optional, absent counts as 0
///       measured_position  n  u       where the command starts
///       command            n  u       optional; what is really sent, if a later stage changes it
///       chosen             n  u/s     the method's answer to `wish`
/// out   wish   n  u/s
///       delta  n  u
/// state c      n  u
///       u      n  u/s
/// throws ConfigError if there is no such model, period is not positive, or position_gain not in
///        (0, 1 / period]
/// source as SafetyFilter
class VelocityLoop final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "turns velocities that a method chooses into a delta",
      "wish = velocity + position_gain (position - command); delta = c + u period - position", ""};
  struct Params {
    std::string model{};
    Period period{};
    double position_gain{5.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  VelocityLoop(const Params& params, const ModelSet& models);

 private:
  using OptionalVector = std::optional<VectorView>;
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const DiscreteState<Vector> c_;
  const DiscreteState<Vector> u_;
  void Start(VectorView measured, MutableVectorView c) const;
  void CalcWish(VectorView request, OptionalVector rate, OptionalVector rate_rate,
                OptionalVector sent, VectorView c, VectorView u, MutableVectorView out) const;
  void CalcDelta(VectorView request, VectorView c, VectorView u, MutableVectorView out) const;
  void Update(VectorView velocity, OptionalVector sent, MutableVectorView c,
              MutableVectorView u) const;

 public:
  const Input<Vector> position;
  const OptionalInput<Vector> velocity;
  const OptionalInput<Vector> acceleration;
  const Input<Vector> measured_position;
  const OptionalInput<Vector> command;
  const Input<Vector> chosen;
  const Output<Vector> wish;
  const Output<Vector> delta;
};

}  // namespace oca::systems
