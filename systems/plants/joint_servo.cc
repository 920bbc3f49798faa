// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/plants/joint_servo.h"

#include "oca/systems/basics/require.h"

namespace oca::systems {
namespace {

JointServo::Params Checked(const JointServo::Params& params) {
  Validated(params);
  if (params.mode == ServoMode::kDeadbeat) RequirePositive("period", params.period);
  return params;
}

}  // namespace

std::span<const char* const> EnumNames(ServoMode) {
  static constexpr const char* kNames[] = {"deadbeat", "second_order"};
  return kNames;
}

void JointServo::Params::Describe(Fields<Params>& fields) {
  fields.Add("mode", &Params::mode, "", "deadbeat commands velocity, second_order acceleration");
  fields.Add("period", &Params::period, "s", "control period, in mode deadbeat").AtLeast(0.0);
  fields.Add("natural_frequency", &Params::natural_frequency, "rad/s", "w, in mode second_order")
      .Above(0.0);
  fields.Add("damping_ratio", &Params::damping_ratio, "", "z, in mode second_order").AtLeast(0.0);
}

JointServo::JointServo(const Params& params)
    : params_(Checked(params)),
      size_(DeclareSize({{"natural_frequency", &params_.natural_frequency},
                         {"damping_ratio", &params_.damping_ratio}})),
      unit_(DeclareUnit()),
      x_(deadbeat() ? DeclareDiscreteState("x", {size_, unit_}, 0.0) : DiscreteState<Vector>{}),
      position(DeclareInput<Vector>("position", {size_, unit_})),
      velocity(DeclareOptionalInput<Vector>("velocity", {size_, unit_.Rate()})),
      measured_position(DeclareInput<Vector>("measured_position", {size_, unit_})),
      measured_velocity(DeclareMeasuredVelocity()),
      command(DeclareCommand()) {
  if (!deadbeat()) return;
  DeclareInitialization<&JointServo::Sample>(Writes(x_), measured_position);
  DeclareUpdate<&JointServo::Sample>(Every{params_.period}, Writes(x_), measured_position);
}

OptionalInput<Vector> JointServo::DeclareMeasuredVelocity() {
  const PortSpec spec{size_, unit_.Rate()};
  if (deadbeat()) return DeclareOptionalInput<Vector>("measured_velocity", spec);
  // Declared as required, so that Build refuses a servo without damping.
  return DeclareInput<Vector>("measured_velocity", spec);
}

Output<Vector> JointServo::DeclareCommand() {
  if (deadbeat()) {
    return DeclareOutput<Vector, &JointServo::CalcDeadbeat>("command", {size_, unit_.Rate()},
                                                            position, x_);
  }
  return DeclareOutput<Vector, &JointServo::CalcSecondOrder>(
      "command", {size_, unit_.Rate().Rate()}, position, velocity, measured_position,
      measured_velocity);
}

void JointServo::CalcDeadbeat(VectorView target, VectorView x, MutableVectorView out) const {
  out = (target - x) / params_.period.seconds();
}

void JointServo::CalcSecondOrder(VectorView target, std::optional<VectorView> target_velocity,
                                 VectorView q, std::optional<VectorView> v,
                                 MutableVectorView out) const {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double w = params_.natural_frequency[i];
    const double rate_error = (target_velocity ? (*target_velocity)[i] : 0.0) - (*v)[i];
    out[i] = w * w * (target[i] - q[i]) + 2.0 * params_.damping_ratio[i] * w * rate_error;
  }
}

void JointServo::Sample(VectorView q, MutableVectorView next) const { next = q; }

}  // namespace oca::systems
