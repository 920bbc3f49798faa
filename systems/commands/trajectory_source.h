// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "oca/framework/dataflow/system.h"
#include "oca/models/motion/trajectory.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/request_ahead.h"

namespace oca::systems {

/// A trajectory as a source of signals; what SplineGenerator and LinearInterpolator share.
///
/// `Request` names the parameters, with `period` and `unit` among them, says how they are checked
/// and what trajectory they mean, and documents the type.
///
/// `period` 0: the outputs are functions of time. `period` > 0: sampled and held; within
/// [t_k, t_k + period) the outputs are those of t_k + period, what a controller should have
/// reached when the period ends; before the first tick they are those of time 0.
///
/// in    -
/// out   position      n  u
///       velocity      n  u/s
///       acceleration  n  u/s^2
///       goal          n  u      position of the last key point
///       ahead         RequestAhead  the whole motion, for who plans ahead
/// state position, velocity, acceleration  n   if sampled
template <class Request>
class TrajectorySource final : public System {
 public:
  static constexpr SystemDoc kDoc = Request::kDoc;
  using Params = typename Request::Params;
  static Params Example() { return Request::Example(); }

  explicit TrajectorySource(const Params& params)
      : params_(Request::Checked(params)),
        ahead_{std::make_shared<const motion::Trajectory>(Request::MakeTrajectory(params_)),
               params_.period},
        trajectory_(*ahead_.trajectory),
        spec_{static_cast<int>(trajectory_.size()), Unit(params_.unit)},
        rate_spec_{spec_.size, spec_.unit.Rate()},
        rate_rate_spec_{spec_.size, rate_spec_.unit.Rate()},
        sampled_position_(DeclareSample("position", spec_, 0)),
        sampled_velocity_(DeclareSample("velocity", rate_spec_, 1)),
        sampled_acceleration_(DeclareSample("acceleration", rate_rate_spec_, 2)),
        position(DeclareMotion<0>("position", spec_, sampled_position_)),
        velocity(DeclareMotion<1>("velocity", rate_spec_, sampled_velocity_)),
        acceleration(DeclareMotion<2>("acceleration", rate_rate_spec_, sampled_acceleration_)),
        goal(DeclareOutput<Vector, &TrajectorySource::CalcGoal>("goal", spec_)),
        ahead(DeclareOutput<RequestAhead, &TrajectorySource::CalcAhead>("ahead", {})) {
    if (!sampled()) return;
    DeclareUpdate<&TrajectorySource::Sample>(
        Every{params_.period}, Writes(sampled_position_, sampled_velocity_, sampled_acceleration_),
        kTime);
  }
  /// Of requests that speak of a robot.
  TrajectorySource(const Params& params, const ModelSet& models) requires requires {
    Request::Resolved(params, models);
  } : TrajectorySource(Request::Resolved(params, models)) {
  }

 private:
  bool sampled() const { return params_.period.positive(); }
  DiscreteState<Vector> DeclareSample(const char* name, const PortSpec& spec, int derivative) {
    if (!sampled()) return {};
    return DeclareDiscreteState(name, spec, trajectory_.Evaluate(0.0, derivative));
  }
  template <int kDerivative>
  Output<Vector> DeclareMotion(const char* name, const PortSpec& spec,
                               const DiscreteState<Vector>& sample) {
    if (sampled()) return DeclareStateOutput(name, sample);
    return DeclareOutput<Vector, &TrajectorySource::CalcMotion<kDerivative>>(name, spec, kTime);
  }
  template <int kDerivative>
  void CalcMotion(double time, MutableVectorView out) const {
    trajectory_.Evaluate(time, kDerivative, out);
  }
  void CalcGoal(MutableVectorView out) const { out = trajectory_.goal(); }
  void CalcAhead(RequestAhead& out) const { out = ahead_; }
  void Sample(double time, MutableVectorView next_position, MutableVectorView next_velocity,
              MutableVectorView next_acceleration) const {
    const double end = params_.period.TickAfter(time);
    trajectory_.Evaluate(end, 0, next_position);
    trajectory_.Evaluate(end, 1, next_velocity);
    trajectory_.Evaluate(end, 2, next_acceleration);
  }

  const Params params_;
  const RequestAhead ahead_;
  const motion::Trajectory& trajectory_;
  const PortSpec spec_;  ///< of the position
  const PortSpec rate_spec_;
  const PortSpec rate_rate_spec_;
  const DiscreteState<Vector> sampled_position_;  ///< this and the next two if sampled
  const DiscreteState<Vector> sampled_velocity_;
  const DiscreteState<Vector> sampled_acceleration_;

 public:
  const Output<Vector> position;
  const Output<Vector> velocity;
  const Output<Vector> acceleration;
  const Output<Vector> goal;
  const Output<RequestAhead> ahead;
};

}  // namespace oca::systems
