// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/judging/motion_metrics.h"

#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca {

Fault Signal<robot::MotionTally>::Check(const robot::MotionTally& value, Look /*look*/) {
  return Fault::UnlessFinite(value.finite());
}

}  // namespace oca

namespace oca::systems {

void MotionMetrics::Params::Describe(Fields<Params>& fields) {
  fields.Add("period", &Params::period, "s", "time between samples; that of control")
      .Above(0.0)
      .Required();
  fields.Add("model", &Params::model, "",
             "robot whose position comes in, for certified_min_distance; none if left out");
  fields.Add("looks", &Params::looks, "", "how often distances are looked at in a period")
      .AtLeast(1)
      .AtMost(1000);
}

MotionMetrics::MotionMetrics(const Params& params, const ModelSet& models)
    : looks_(Validated(params).looks),
      between_(params.period.numerator(), params.period.denominator() * params.looks),
      model_(params.model.empty() ? nullptr : MovableModel(models, params.model)),
      travel_(model_ ? std::optional<robot::TravelBound>(*model_) : std::nullopt),
      spec_(MakeSpec()),
      x_(DeclareDiscreteState<robot::MotionTally>("x", {})),
      position(DeclareOptionalInput<Vector>("position", spec_)),
      request(DeclareOptionalInput<Vector>("request", spec_)),
      goal(DeclareOptionalInput<Vector>("goal", spec_)),
      delta(DeclareOptionalInput<Vector>("delta", PortSpec{spec_.size, spec_.unit})),
      proximities(DeclareOptionalInput<ProximitySet>("proximities")),
      tally_(DeclareCached<&MotionMetrics::CalcTally>(kTime, position, request, goal, delta,
                                                      proximities, x_)),
      metrics(DeclareOutput<MotionMetricsValue, &MotionMetrics::CalcMetrics>(
          "metrics", {}, kTime, position, request, goal, delta, proximities, tally_)) {
  DeclareUpdate<&MotionMetrics::Update>(Every{between_}, Writes(x_), kTime, position, request, goal,
                                        delta, proximities);
  DeclareRole(Boundary{"the judge"});
  DeclareRole(Judges{.metrics = metrics,
                     .position = position,
                     .request = request,
                     .delta = delta,
                     .proximities = proximities,
                     .model = models.FullName(params.model)});
  DeclareRole(Plots{.id = "requested", .title = "Requested joints", .signal = request});
  DeclareRole(Plots{.id = "delta", .title = "Deltas of the avoidance", .signal = delta});
  DeclareRole(Plots{.id = "final", .title = "Final joints", .signal = position});
}

PortSpec MotionMetrics::MakeSpec() {
  return model_ ? PositionSpec(*model_) : PortSpec{DeclareSize(), DeclareUnit()};
}

robot::MotionSample MotionMetrics::Sample(double time, OptionalVector position_value,
                                          OptionalVector request_value, OptionalVector goal_value,
                                          OptionalVector delta_value,
                                          const ProximitySet* proximity_set) const {
  return {time,        position_value, request_value, goal_value,
          delta_value, proximity_set,  model_.get(),  travel_ ? &*travel_ : nullptr};
}

void MotionMetrics::Update(double time, OptionalVector position_value, OptionalVector request_value,
                           OptionalVector goal_value, OptionalVector delta_value,
                           const ProximitySet* proximity_set, robot::MotionTally& next) const {
  Add(Sample(time, position_value, request_value, goal_value, delta_value, proximity_set), next);
}

void MotionMetrics::Add(const robot::MotionSample& sample, robot::MotionTally& tally) const {
  if (tally.samples() == 0 || tally.looks() + 1 == looks_) {
    tally.Add(sample);
  } else {
    tally.Look(sample);
  }
}

void MotionMetrics::CalcTally(double time, OptionalVector position_value,
                              OptionalVector request_value, OptionalVector goal_value,
                              OptionalVector delta_value, const ProximitySet* proximity_set,
                              const robot::MotionTally& x, robot::MotionTally& value) const {
  value = x;
  // Times of ticks are rationals rounded to doubles, so their differences are off by a little.
  const bool pending = x.samples() == 0 || time - x.looked_at() > 0.999999 * between_.seconds();
  if (!pending) return;
  Add(Sample(time, position_value, request_value, goal_value, delta_value, proximity_set), value);
}

void MotionMetrics::CalcMetrics(double time, OptionalVector position_value,
                                OptionalVector request_value, OptionalVector goal_value,
                                OptionalVector delta_value, const ProximitySet* proximity_set,
                                const robot::MotionTally& complete,
                                MotionMetricsValue& value) const {
  value = complete.At(
      Sample(time, position_value, request_value, goal_value, delta_value, proximity_set));
}

}  // namespace oca::systems
