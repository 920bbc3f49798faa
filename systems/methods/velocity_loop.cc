// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/velocity_loop.h"

#include "oca/models/motion/following.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {
namespace {

VelocityLoop::Params Checked(const VelocityLoop::Params& params) {
  Validated(params);
  RequireGain("position_gain", params.position_gain, params.period);
  return params;
}

}  // namespace

void VelocityLoop::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  AddControlPeriod(fields);
  fields
      .Add("position_gain", &Params::position_gain, "1/s",
           "how fast the arm returns to the request; at most 1 / period")
      .Above(0.0);
}

VelocityLoop::VelocityLoop(const Params& params, const ModelSet& models)
    : params_(Checked(params)),
      model_(MovableModel(models, params.model)),
      c_(DeclareDiscreteState("c", DeltaSpec(*model_), 0.0)),
      u_(DeclareDiscreteState("u", RateSpec(*model_), 0.0)),
      position(DeclareInput<Vector>("position", DeltaSpec(*model_))),
      velocity(DeclareOptionalInput<Vector>("velocity", RateSpec(*model_))),
      acceleration(DeclareOptionalInput<Vector>(
          "acceleration", {model_->num_positions(), RateSpec(*model_).unit.Rate()})),
      measured_position(DeclareInput<Vector>("measured_position", PositionSpec(*model_))),
      command(DeclareOptionalInput<Vector>("command", PositionSpec(*model_))),
      chosen(DeclareInput<Vector>("chosen", RateSpec(*model_))),
      wish(DeclareOutput<Vector, &VelocityLoop::CalcWish>("wish", RateSpec(*model_), position,
                                                          velocity, acceleration, command, c_, u_)),
      delta(DeclareOutput<Vector, &VelocityLoop::CalcDelta>("delta", DeltaSpec(*model_), position,
                                                            c_, u_)) {
  DeclareInitialization<&VelocityLoop::Start>(Writes(c_), measured_position);
  DeclareUpdate<&VelocityLoop::Update>(Every{params_.period}, Writes(c_, u_), chosen, command);
}

void VelocityLoop::Start(VectorView measured, MutableVectorView c) const { c = measured; }

void VelocityLoop::CalcWish(VectorView request, OptionalVector rate, OptionalVector rate_rate,
                            OptionalVector sent, VectorView c, VectorView u,
                            MutableVectorView out) const {
  const double dt = params_.period.seconds();
  for (Eigen::Index j = 0; j < request.size(); ++j) {
    const motion::JointRequest joint{request[j], rate ? (*rate)[j] : 0.0,
                                     rate_rate ? (*rate_rate)[j] : 0.0};
    out[j] = motion::FollowingVelocity(joint, sent ? (*sent)[j] : c[j] + dt * u[j],
                                       params_.position_gain, model_->acceleration_limits()[j], dt);
  }
}

void VelocityLoop::CalcDelta(VectorView request, VectorView c, VectorView u,
                             MutableVectorView out) const {
  out = c + u * params_.period.seconds() - request;
}

void VelocityLoop::Update(VectorView answer, OptionalVector sent, MutableVectorView c,
                          MutableVectorView u) const {
  if (sent) {
    c = *sent;
  } else {
    c += u * params_.period.seconds();
  }
  u = answer;
}

}  // namespace oca::systems
