// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/commands/posture.h"

namespace oca::systems {

/// Joints as integrators.
///
///     order 1:  position' = command
///     order 2:  position' = velocity,  velocity' = command
///
/// `lower` and `upper` are hard stops, a side at a time: while position >= upper, a derivative of
/// the position that points up counts as 0, and in order 2 so does a command that points up;
/// likewise down at the lower stop. The output `velocity` shows position'. In order 2 a stop does
/// not destroy the velocity state: the joint leaves the stop once the command has braked it. The
/// integrator finds no event at a stop, so the state may pass it by what one step carries it; the
/// output `position` never does, it is the state clamped to the stops.
///
/// `initial_position` is a number for all or one a joint; or, of the robot that `model` names, a
/// state of its SRDF or some joints by name: the others are at 0 or the limit nearest to it.
///
/// in    command   n  u/s (order 1), u/s^2 (order 2)
/// out   position  n  u
///       velocity  n  u/s   position'; order 1: the command, with feedthrough
/// state position  n  u     continuous
///       velocity  n  u/s   continuous, order 2 only
/// throws ConfigError if order is not 1 or 2, lists differ in length, a number is not finite,
///        order 1 has an initial velocity, lower > upper, or initial_position is beyond a stop or
///        names what the robot does not have
class IntegratorPlant final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "joints as integrators of velocity or acceleration commands",
      "order 1: position' = command; order 2: position' = velocity, velocity' = command", ""};
  struct Params {
    int order{1};
    Posture initial_position{0.0};
    PerComponent initial_velocity{0.0};
    std::optional<PerComponent> lower{};
    std::optional<PerComponent> upper{};
    std::string model{};
    std::string unit{"rad"};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.initial_position = Eigen::VectorXd(Eigen::Vector2d(0, 1))}; }

  /// `initial_position` in numbers.
  explicit IntegratorPlant(const Params& params);
  /// It may name a state or joints of a robot.
  IntegratorPlant(const Params& params, const ModelSet& models);

 private:
  const Params params_;
  const PerComponent lower_;  ///< -infinity for none
  const PerComponent upper_;  ///< +infinity for none
  const PortSpec spec_;       ///< of the position
  const PortSpec rate_spec_;
  const ContinuousState position_;
  const ContinuousState velocity_;  ///< in order 2

  bool limited() const { return params_.lower || params_.upper; }
  ContinuousState DeclareVelocity();
  Output<Vector> DeclareShownPosition();
  Output<Vector> DeclareShownVelocity();
  /// `push` where it may move the joints, 0 where it points into a stop.
  void CalcFree(VectorView push, VectorView q, MutableVectorView free) const;
  void CalcShownPosition(VectorView q, MutableVectorView shown) const;

 public:
  const Input<Vector> command;
  const Output<Vector> position;
  const Output<Vector> velocity;
};

}  // namespace oca::systems
