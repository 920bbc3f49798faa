// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/servo_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/methods/velocity_methods.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {

struct ServoScaling::Slowed {
  double share{0.0};  ///< of the request that is held back
  std::vector<Eigen::Isometry3d> reordered;
};

void ServoScaling::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  AddControlPeriod(fields);
  fields
      .Add("slow_distance", &Params::slow_distance, "m",
           "from an obstacle, below which the motion is slowed")
      .Above(0.0);
  fields
      .Add("own_slow_distance", &Params::own_slow_distance, "m",
           "between two links of the arm, likewise")
      .Above(0.0);
  fields.Add("approach_only", &Params::approach_only, "",
             "true: a motion away from obstacles is not slowed; false: Servo's own law");
}

ServoScaling::ServoScaling(const Params& params, const ModelSet& models)
    : period_(Validated(params).period),
      law_{params.slow_distance, params.own_slow_distance, params.approach_only},
      model_(FilteredModel(models, params.model)),
      s_(DeclareDiscreteState("s", {1, "s"}, 0.0)),
      proximities(DeclareInput<ProximitySet>("proximities")),
      links(DeclareInput<LinkPoses>("links")),
      ahead(DeclareInput<RequestAhead>("ahead")),
      position(DeclareInput<Vector>("position", DeltaSpec(*model_))),
      slowed_(DeclareCached<&ServoScaling::CalcSlowed>(proximities, links, ahead, s_)),
      scale(DeclareOutput<Vector, &ServoScaling::CalcScale>("scale", {1, Unit::Any()}, slowed_)),
      delta(DeclareOutput<Vector, &ServoScaling::CalcDelta>("delta", DeltaSpec(*model_), ahead,
                                                            position, s_)),
      path_time(DeclareStateOutput("path_time", s_)) {
  DeclareInitialization<&ServoScaling::Start>(Writes(s_), kTime);
  DeclareUpdate<&ServoScaling::Update>(Every{period_}, Writes(s_), kTime, scale);
  DeclareRole(Limits{.shown = Limits::Shown::kBelow,
                     .signal = scale,
                     .bound = {1.0},
                     .how = "slowed",
                     .period = period_});
}

const motion::Trajectory* ServoScaling::Known(const RequestAhead& request) const {
  const motion::Trajectory* known = request.trajectory.get();
  if (known == nullptr || known->size() == model_->num_positions()) return known;
  throw ConfigError(fmt::format("ahead: length; got {} joints; expected {}", known->size(),
                                model_->num_positions()));
}

void ServoScaling::Start(double time, MutableVectorView s) const { s[0] = time; }

void ServoScaling::CalcSlowed(const ProximitySet& set, const LinkPoses& poses,
                              const RequestAhead& request, VectorView s, Slowed& result) const {
  const auto X_WL = PosesInOrder(*model_, poses, result.reordered);
  robot::JointVector rate = robot::JointVector::Zero(model_->num_positions());
  const motion::Trajectory* known = Known(request);
  if (known != nullptr) known->Evaluate(s[0], 1, rate);
  double least = known != nullptr ? 1.0 : 0.0;
  for (const Proximity& proximity : set.proximities) {
    least = std::min(least, law_.Scale(*model_, X_WL, proximity, rate));
  }
  result.share = 1.0 - least;
}

void ServoScaling::CalcScale(const Slowed& result, MutableVectorView out) const {
  out[0] = 1.0 - result.share;
}

void ServoScaling::CalcDelta(const RequestAhead& request, VectorView now, VectorView s,
                             MutableVectorView out) const {
  const motion::Trajectory* known = Known(request);
  if (known == nullptr) {
    out.setZero();
    return;
  }
  known->Evaluate(s[0], 0, out);
  out -= now;
}

/// What was never slowed is exactly on time, as a sum of periods would not be.
void ServoScaling::Update(double time, VectorView value, MutableVectorView s) const {
  const bool on_time = s[0] == time && value[0] == 1.0;
  s[0] = on_time ? period_.TickAfter(time) : s[0] + value[0] * period_.seconds();
}

}  // namespace oca::systems
