// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/safety_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca {

Fault Signal<robot::WitnessPairs>::Check(const robot::WitnessPairs& value, Look /*look*/) {
  const auto pairs = value.pairs();
  return Fault::UnlessFinite(std::all_of(pairs.begin(), pairs.end(), [](const auto& pair) {
    return pair.point_on_link.allFinite() && pair.point_on_obstacle.allFinite();
  }));
}

}  // namespace oca

namespace oca::systems {
namespace {

constexpr double kFading = 10.0;  // s, of the way that a joint was led

SafetyFilter::Params Checked(const SafetyFilter::Params& params) {
  Validated(params);
  RequireGain("approach_gain", params.approach_gain, params.period);
  RequireGain("position_gain", params.position_gain, params.period);
  RequireGain("recovery_gain", params.recovery_gain, params.period);
  return params;
}

/// throws ConfigError if there are neither one weight nor one a joint
robot::BarrierSettings SettingsOf(const SafetyFilter::Params& params,
                                  const robot::RobotModel& model) {
  const Eigen::Index n = model.num_positions();
  if (!params.weights.scalar() && params.weights.values().size() != n) {
    throw ConfigError(fmt::format("weights: got {} numbers; expected 1 or {}",
                                  params.weights.values().size(), n));
  }
  Eigen::VectorXd weights(n);
  for (Eigen::Index j = 0; j < n; ++j) weights[j] = params.weights[j];
  return {.period = params.period.seconds(),
          .safe_distance = params.safe_distance,
          .form = params.form == SafetyFilter::Form::kLinear
                      ? robot::BarrierSettings::Form::kLinear
                      : robot::BarrierSettings::Form::kBraking,
          .approach_gain = params.approach_gain,
          .deceleration = params.deceleration,
          .position_gain = params.position_gain,
          .weights = std::move(weights),
          .progress_weight = params.progress_weight,
          .slack_penalty = params.slack_penalty,
          .trust_time = params.trust_time,
          .recovery_gain = params.recovery_gain,
          .recovery_speed = params.recovery_speed,
          .recovery_penalty = params.recovery_penalty,
          .most_rows = params.most_rows};
}

}  // namespace

struct SafetyFilter::Solution : robot::BarrierFilter::Solution {
  std::vector<Eigen::Isometry3d> reordered;
};

void SafetyFilter::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  AddControlPeriod(fields);
  fields
      .Add("safe_distance", &Params::safe_distance, "m",
           "distance that is kept, but for the margin of docs/explanation/safety_filter.md")
      .AtLeast(0.0);
  fields.Add("form", &Params::form, "", "how fast the arm may approach: linear or braking");
  fields
      .Add("approach_gain", &Params::approach_gain, "1/s",
           "linear: share of the headroom that may be used up in a second; at most 1 / period")
      .Above(0.0);
  fields
      .Add("deceleration", &Params::deceleration, "m/s^2",
           "braking: deceleration along the normal that the arm can count on")
      .Above(0.0);
  fields
      .Add("position_gain", &Params::position_gain, "1/s",
           "how fast the arm returns to the request; at most 1 / period")
      .Above(0.0);
  fields
      .Add("weights", &Params::weights, "",
           "price of a joint's deviation, one number or one a joint")
      .Above(0.0);
  fields
      .Add("progress_weight", &Params::progress_weight, "",
           "how much dearer a joint is that has a way to go: 0 not at all, 10 evades with the "
           "others")
      .AtLeast(0.0);
  fields
      .Add("slack_penalty", &Params::slack_penalty, "rad^2/(m s)",
           "price of a distance that is not kept; too low a one gives way early")
      .Above(0.0);
  fields
      .Add("trust_time", &Params::trust_time, "s",
           "a request that is clear for longer is let through")
      .AtLeast(0.0);
  fields
      .Add("recovery_gain", &Params::recovery_gain, "1/s",
           "how fast a distance below safe_distance should grow; at most 1 / period")
      .Above(0.0);
  fields.Add("recovery_speed", &Params::recovery_speed, "m/s", "but no faster than this")
      .AtLeast(0.0);
  fields
      .Add("recovery_penalty", &Params::recovery_penalty, "rad^2/(m s)",
           "price of growing more slowly")
      .AtLeast(0.0);
  fields
      .Add("most_rows", &Params::most_rows, "",
           "room for rows; if there are more, those farthest away are dropped and counted")
      .AtLeast(1.0);
}

SafetyFilter::SafetyFilter(const Params& params, const ModelSet& models)
    : params_(Checked(params)),
      model_(MovableModel(models, params.model)),
      filter_(model_, SettingsOf(params_, *model_)),
      c_(DeclareDiscreteState("c", DeltaSpec(*model_), 0.0)),
      u_(DeclareDiscreteState("u", RateSpec(*model_), 0.0)),
      l_(DeclareDiscreteState("l", DeltaSpec(*model_), 0.0)),
      activity_(DeclareDiscreteState("activity", FilterActivity{})),
      witnesses_(DeclareDiscreteState("witnesses", robot::WitnessPairs{})),
      proximities(DeclareInput<ProximitySet>("proximities")),
      links(DeclareInput<LinkPoses>("links")),
      position(DeclareInput<Vector>("position", DeltaSpec(*model_))),
      velocity(DeclareOptionalInput<Vector>("velocity", RateSpec(*model_))),
      acceleration(DeclareOptionalInput<Vector>(
          "acceleration", {model_->num_positions(), RateSpec(*model_).unit.Rate()})),
      measured_position(DeclareInput<Vector>("measured_position", PositionSpec(*model_))),
      command(DeclareOptionalInput<Vector>("command", PositionSpec(*model_))),
      clear(DeclareOptionalInput<ClearMotion>("clear")),
      solution_(DeclareCached<&SafetyFilter::CalcSolution>(proximities, links, position, velocity,
                                                           acceleration, command, clear, c_, u_, l_,
                                                           activity_, witnesses_)),
      delta(DeclareOutput<Vector, &SafetyFilter::CalcDelta>("delta", DeltaSpec(*model_), position,
                                                            c_, u_)),
      activity(DeclareStateOutput("activity", activity_)) {
  DeclareInitialization<&SafetyFilter::Start>(Writes(c_), measured_position);
  DeclareUpdate<&SafetyFilter::Update>(Every{params_.period},
                                       Writes(c_, u_, l_, activity_, witnesses_), solution_,
                                       command, velocity);
  DeclareRole(Limits{.shown = Limits::Shown::kListed,
                     .signal = activity,
                     .member = "bounds",
                     .period = params_.period});
  DeclareRole(Remarks{.notes = [this] { return std::vector<std::string>{DescribeMargin()}; }});
}

std::string SafetyFilter::DescribeMargin() const {
  const double reach = filter_.reach();
  const double fastest = model_->velocity_limits().sum();
  std::string text = fmt::format(
      "keeps {} m, less {:.3g} m while its joint speeds add up to 1 rad/s, {:.3g} m with obstacles "
      "at 1 m/s besides",
      params_.safe_distance, filter_.TickMargin(1.0, reach, 0.0),
      filter_.TickMargin(1.0, reach, 1.0));
  if (std::isfinite(fastest)) {
    text += fmt::format(", {:.3g} m with all joints at their limits",
                        filter_.TickMargin(fastest, reach, 0.0));
  }
  return text;
}

void SafetyFilter::Start(VectorView measured, MutableVectorView c) const { c = measured; }

void SafetyFilter::Update(const Solution& result, OptionalVector sent, OptionalVector rate,
                          MutableVectorView c, MutableVectorView u, MutableVectorView l,
                          FilterActivity& last, robot::WitnessPairs& witnesses) const {
  if (sent) {
    c = *sent;
  } else {
    c += u * params_.period.seconds();
  }
  u = result.velocity;
  const double dt = params_.period.seconds();
  l *= std::max(1.0 - dt / kFading, 0.0);
  if (rate) l += dt * rate->cwiseAbs();
  last = result.activity;
  witnesses = result.witnesses;
}

void SafetyFilter::CalcDelta(VectorView request, VectorView c, VectorView u,
                             MutableVectorView out) const {
  out = c + u * params_.period.seconds() - request;
}

void SafetyFilter::CalcSolution(const ProximitySet& set, const LinkPoses& poses, VectorView request,
                                OptionalVector rate, OptionalVector rate_rate, OptionalVector sent,
                                const ClearMotion* clear_motion, VectorView c, VectorView u,
                                VectorView l, const FilterActivity& last,
                                const robot::WitnessPairs& witnesses, Solution& result) const {
  const double dt = params_.period.seconds();
  if (sent) {
    result.command = *sent;
  } else {
    result.command = c + u * dt;
  }
  result.last_velocity = (result.command - c) / dt;
  const auto X_WL = PosesInOrder(*model_, poses, result.reordered);
  filter_.Solve({X_WL, set, request, rate, rate_rate, clear_motion, l, last, witnesses}, result);
}

}  // namespace oca::systems
