// SPDX-License-Identifier: BSD-3-Clause
#include "systems/linear_interpolator.h"

#include "systems/require.h"

namespace oca::systems {
namespace {

LinearInterpolator::Params Checked(LinearInterpolator::Params params) {
  RequireNotNegative("period", params.period);
  params.key_points = KeyPointsFrom(params.key_points, params.file);
  return params;
}

}  // namespace

void LinearInterpolator::Params::Describe(Fields<Params>& fields) {
  fields.Add("key_points", &Params::key_points, "", "points in order of time");
  fields.Add("file", &Params::file, "", "CSV file of key points (time, p1..pn) instead");
  fields
      .Add("period", &Params::period, "s",
           "0: continuous in time; > 0: sampled for the end of each period and held")
      .AtLeast(0.0);
  fields.Add("unit", &Params::unit, "", "unit of the position");
}

LinearInterpolator::Params LinearInterpolator::Example() {
  return {.key_points = {{.time = 0.0, .position = Eigen::Vector2d(0.0, 1.0)},
                         {.time = 1.0, .position = Eigen::Vector2d(0.5, -1.0)}}};
}

LinearInterpolator::LinearInterpolator(const Params& params)
    : params_(Checked(params)),
      trajectory_(Trajectory::Linear(params_.key_points)),
      spec_{static_cast<int>(trajectory_.size()), Unit(params_.unit)},
      rate_spec_{spec_.size, spec_.unit.Rate()},
      rate_rate_spec_{spec_.size, rate_spec_.unit.Rate()},
      sampled_position_(DeclareSample("position", spec_, 0)),
      sampled_velocity_(DeclareSample("velocity", rate_spec_, 1)),
      sampled_acceleration_(DeclareSample("acceleration", rate_rate_spec_, 2)),
      position(
          DeclareMotion<&LinearInterpolator::CalcPosition>("position", spec_, sampled_position_)),
      velocity(DeclareMotion<&LinearInterpolator::CalcVelocity>("velocity", rate_spec_,
                                                                sampled_velocity_)),
      acceleration(DeclareMotion<&LinearInterpolator::CalcAcceleration>(
          "acceleration", rate_rate_spec_, sampled_acceleration_)),
      goal(DeclareOutput<Vector, &LinearInterpolator::CalcGoal>("goal", spec_)) {
  if (!params_.period.positive()) return;
  DeclareUpdate<&LinearInterpolator::Sample>(
      Every{params_.period}, Writes(sampled_position_, sampled_velocity_, sampled_acceleration_),
      kTime);
}

DiscreteState<Vector> LinearInterpolator::DeclareSample(const char* name, const PortSpec& spec,
                                                        int derivative) {
  if (!params_.period.positive()) return {};
  return DeclareDiscreteState(name, spec, trajectory_.Evaluate(0.0, derivative));
}

template <auto kMethod>
Output<Vector> LinearInterpolator::DeclareMotion(const char* name, const PortSpec& spec,
                                                 const DiscreteState<Vector>& sampled) {
  if (params_.period.positive()) return DeclareStateOutput(name, sampled);
  return DeclareOutput<Vector, kMethod>(name, spec, kTime);
}

void LinearInterpolator::CalcPosition(double time, MutableVectorView out) const {
  trajectory_.Evaluate(time, 0, out);
}

void LinearInterpolator::CalcVelocity(double time, MutableVectorView out) const {
  trajectory_.Evaluate(time, 1, out);
}

void LinearInterpolator::CalcAcceleration(double time, MutableVectorView out) const {
  trajectory_.Evaluate(time, 2, out);
}

void LinearInterpolator::CalcGoal(MutableVectorView out) const { out = trajectory_.goal(); }

void LinearInterpolator::Sample(double time, MutableVectorView next_position,
                                MutableVectorView next_velocity,
                                MutableVectorView next_acceleration) const {
  const double end = time + params_.period.seconds();
  trajectory_.Evaluate(end, 0, next_position);
  trajectory_.Evaluate(end, 1, next_velocity);
  trajectory_.Evaluate(end, 2, next_acceleration);
}

}  // namespace oca::systems
