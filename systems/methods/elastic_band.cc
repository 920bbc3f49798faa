// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/elastic_band.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {
namespace {

constexpr double kSameTick = 1e-9;         // s
constexpr double kLongestHorizon = 600.0;  // s; a plan looks at 2.5 to 20 places a second

ElasticBand::Params Checked(const ElasticBand::Params& params) {
  Validated(params);
  if (params.plan_period.seconds() < params.period.seconds()) {
    throw ConfigError(fmt::format("plan_period: got {} s; expected at least period, {} s",
                                  params.plan_period.seconds(), params.period.seconds()));
  }
  if (params.clear_distance > params.margin) {
    throw ConfigError(fmt::format("clear_distance: got {} m; expected at most margin, {} m",
                                  params.clear_distance, params.margin));
  }
  if (params.hard_distance > params.clear_distance) {
    throw ConfigError(fmt::format("hard_distance: got {} m; expected at most clear_distance, {} m",
                                  params.hard_distance, params.clear_distance));
  }
  for (const double distance : {params.trust_distance, params.flying_distance}) {
    if (distance <= params.clear_distance) continue;
    throw ConfigError(fmt::format(
        "trust_distance, flying_distance: got {} m; expected at most clear_distance, {} m",
        distance, params.clear_distance));
  }
  RequireAtLeast("most_horizon", params.most_horizon, params.least_horizon);
  return params;
}

void RequireSize(const motion::Trajectory& request, Eigen::Index size) {
  if (request.size() == size) return;
  throw ConfigError(fmt::format("ahead: length; got {} joints; expected {}", request.size(), size));
}

void AddDistances(Fields<ElasticBand::Params>& fields) {
  using Params = ElasticBand::Params;
  fields.Add("margin", &Params::margin, "m", "distance up to which obstacles push the band")
      .Above(0.0);
  fields
      .Add("clear_distance", &Params::clear_distance, "m",
           "distance that a band keeps that counts as clear; above the filter's safe_distance")
      .Above(0.0);
  fields
      .Add("hard_distance", &Params::hard_distance, "m",
           "distance from what stands, and of own links, that no plan goes below; start and goal, "
           "if they are nearer but clear, lower it there to their own")
      .Above(0.0);
  fields
      .Add("trust_distance", &Params::trust_distance, "m",
           "distance that a band keeps from what stands that a filter need not correct")
      .AtLeast(0.0);
  fields
      .Add("flying_distance", &Params::flying_distance, "m",
           "distance that a band keeps from what moves that a filter need not correct")
      .AtLeast(0.0);
}

void AddBandPrices(Fields<ElasticBand::Params>& fields) {
  using Params = ElasticBand::Params;
  fields.Add("clearance", &Params::clearance, "1/m^2", "price of a missing margin").Above(0.0);
  fields
      .Add("smoothness", &Params::smoothness, "s^4/rad^2", "price of the deviation's acceleration")
      .Above(0.0);
  fields.Add("nearness", &Params::nearness, "1/rad^2", "price of a deviation").Above(0.0);
  fields.Add("calm", &Params::calm, "s^2/rad^2", "price of the deviation's speed").AtLeast(0.0);
  fields
      .Add("limit_share", &Params::limit_share, "",
           "share of the velocity and acceleration limits that plans may use")
      .Above(0.0)
      .AtMost(1.0);
}

}  // namespace

void ElasticBand::PlanCost::Describe(Fields<PlanCost>& fields) {
  fields.Add("plan", &PlanCost::plan, "s", "a plan, besides").AtLeast(0.0);
  fields.Add("band", &PlanCost::band, "s", "a look at a configuration of a band").Above(0.0);
  fields.Add("exact", &PlanCost::exact, "s", "a look at another by exact distances").Above(0.0);
  fields.Add("batch", &PlanCost::batch, "s", "a look at up to eight of a path at once").Above(0.0);
}

void ElasticBand::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  AddControlPeriod(fields);
  fields.Add("plan_period", &Params::plan_period, "s", "time between plans").Above(0.0);
  fields
      .Add("plan_time", &Params::plan_time, "s",
           "time to make a plan, after which it begins; 0: plan_period")
      .AtLeast(0.0);
  fields
      .Add(
          "plan_budget", &Params::plan_budget, "s",
          "what the work of a plan may count as, about; what can wait is left to the next plan; 0: "
          "plan_time")
      .AtLeast(0.0);
  fields.Add("plan_cost", &Params::plan_cost, "", "what the work of a plan counts as");
  AddDistances(fields);
  AddBandPrices(fields);
  fields.Add("prediction", &Params::prediction, "s", "how long obstacles are taken to go on as now")
      .AtLeast(0.0);
  fields
      .Add("most_evaluations", &Params::most_evaluations, "",
           "configurations that a plan may look at, about")
      .AtLeast(0.0);
  fields
      .Add("moving_horizon", &Params::moving_horizon, "s",
           "largest time that a plan looks ahead while something moves")
      .AtLeast(0.5)
      .AtMost(kLongestHorizon);
  fields.Add("least_horizon", &Params::least_horizon, "s", "least time that a plan looks ahead")
      .AtLeast(0.5)
      .AtMost(kLongestHorizon);
  fields.Add("most_horizon", &Params::most_horizon, "s", "largest time that a plan looks ahead")
      .AtLeast(0.5)
      .AtMost(kLongestHorizon);
  fields
      .Add("restart_distance", &Params::restart_distance, "rad",
           "distance of arm and band above which plans start from the arm")
      .Above(0.0);
  fields.Add("stuck_time", &Params::stuck_time, "s", "without progress, after which it is stuck")
      .Above(0.0);
  fields
      .Add("stuck_motion", &Params::stuck_motion, "rad",
           "nearer to the goal, that counts as progress")
      .Above(0.0);
  fields.Add("self_collision", &Params::self_collision, "", "keeps own links apart too");
  fields
      .Add("self_distance", &Params::self_distance, "m",
           "most distance that own links keep, where the request leaves it; 0: as from obstacles")
      .AtLeast(0.0);
  fields.Add("seed", &Params::seed, "", "of the random starts");
  fields.Add("enabled", &Params::enabled, "", "false: the request as it is");
}

planning::ReplanSettings ElasticBand::SettingsOf(const Params& params, const ModelSet& models) {
  planning::ReplanSettings settings;
  planning::BandPlannerSettings& planner = settings.planner;
  planner.band.margin = params.margin;
  planner.band.clear_distance = params.clear_distance;
  planner.band.hard_distance = params.hard_distance;
  planner.band.trust_distance = params.trust_distance;
  planner.band.flying_distance = params.flying_distance;
  planner.band.clearance = params.clearance;
  planner.band.smoothness = params.smoothness;
  planner.band.calm = params.calm;
  planner.band.nearness = params.nearness;
  planner.band.limit_share = params.limit_share;
  planner.most_evaluations = params.most_evaluations;
  planner.moving_horizon = params.moving_horizon;
  planner.least_horizon = params.least_horizon;
  planner.most_horizon = params.most_horizon;
  settings.plan_time = params.plan_time > 0.0 ? params.plan_time : params.plan_period.seconds();
  settings.plan_budget = params.plan_budget;
  const PlanCost& cost = params.plan_cost;
  planner.prices = {cost.plan, cost.band, cost.exact, cost.batch};
  settings.prediction = params.prediction;
  settings.restart_distance = params.restart_distance;
  settings.stuck_time = params.stuck_time;
  settings.stuck_motion = params.stuck_motion;
  settings.self_collision = params.self_collision;
  settings.self_distance = params.self_distance;
  settings.own_prefix = models.FullName(params.model) + "/";
  settings.seed = static_cast<std::uint64_t>(params.seed);
  return settings;
}

ElasticBand::ElasticBand(const Params& params, const ModelSet& models)
    : params_(Checked(params)),
      model_(MovableModel(models, params.model)),
      replanner_(model_, SettingsOf(params_, models)),
      position_(DeclareDiscreteState("position", PositionSpec(*model_), 0.0)),
      velocity_(DeclareDiscreteState("velocity", RateSpec(*model_), 0.0)),
      acceleration_(DeclareDiscreteState(
          "acceleration", {model_->num_positions(), RateSpec(*model_).unit.Rate()}, 0.0)),
      memory_(DeclareDiscreteState("plan", BandMemory{})),
      ahead(DeclareInput<RequestAhead>("ahead")),
      obstacles(DeclareInput<ObstacleSet>("obstacles")),
      measured_position(DeclareInput<Vector>("measured_position", PositionSpec(*model_))),
      measured_velocity(DeclareOptionalInput<Vector>("measured_velocity", RateSpec(*model_))),
      ignored(DeclareOptionalInput<IgnoredPairs>("ignored")),
      position(DeclareStateOutput("position", position_)),
      velocity(DeclareStateOutput("velocity", velocity_)),
      acceleration(DeclareStateOutput("acceleration", acceleration_)),
      plan(DeclareOutput<BandReport, &BandMemory::report>("plan", {}, memory_)),
      clear(DeclareOutput<ClearMotion, &ElasticBand::CalcClear>(
          "clear", {}, kTime, ahead, obstacles, measured_position, position_, memory_)) {
  DeclareInitialization<&ElasticBand::Start>(Writes(position_), measured_position);
  DeclareUpdate<&ElasticBand::Sample>(
      Every{params_.period}, Writes(position_, velocity_, acceleration_), kTime, ahead, memory_);
  DeclareUpdate<&ElasticBand::Plan>(Every{params_.plan_period}, Writes(memory_), kTime, kLog, ahead,
                                    obstacles, measured_position, measured_velocity, ignored);
  if (!params_.enabled) return;
  DeclareRole(Limits{.shown = Limits::Shown::kBelow,
                     .signal = plan,
                     .bound = {params_.margin},
                     .member = "nearest",
                     .how = "bent around what is near",
                     .period = params_.plan_period});
  DeclareRole(
      KnowsWhatBlocks{[this](const Context& context) { return WhatBlocks(plan.Eval(context)); }});
}

void ElasticBand::Start(VectorView measured, MutableVectorView position_out) const {
  position_out = measured;
}

void ElasticBand::Sample(double time, const RequestAhead& request, const BandMemory& memory,
                         MutableVectorView next_position, MutableVectorView next_velocity,
                         MutableVectorView next_acceleration) const {
  if (!request.trajectory) {
    next_velocity.setZero();
    next_acceleration.setZero();
    return;
  }
  RequireSize(*request.trajectory, next_position.size());
  const double end = params_.period.TickAfter(time);
  const planning::BandCurve& band = memory.At(end);
  MutableVectorView* const next[] = {&next_position, &next_velocity, &next_acceleration};
  for (int d = 0; d < 3; ++d) {
    request.trajectory->Evaluate(end, d, *next[d]);
    if (!band.empty()) band.Add(end, d, *next[d]);
  }
}

void ElasticBand::CalcClear(double time, const RequestAhead& request, const ObstacleSet& set,
                            VectorView measured, VectorView planned, const BandMemory& memory,
                            ClearMotion& motion) const {
  replanner_.TellClear({time, request.trajectory, set.obstacles, measured, set.estimates}, planned,
                       memory, motion);
}

double ElasticBand::BeginOf(double time, const BandMemory& memory) const {
  const double takes = replanner_.TimeToPlan(memory);
  if (takes == params_.plan_period.seconds()) return params_.plan_period.TickAfter(time);
  const double ready = time + takes;
  const double tick = params_.period.seconds(params_.period.CountAt(ready));
  return tick >= ready - kSameTick ? tick : params_.period.TickAfter(ready);
}

void ElasticBand::Plan(double time, Log& log, const RequestAhead& request, const ObstacleSet& set,
                       VectorView measured, std::optional<VectorView> rate,
                       const IgnoredPairs* left_out, BandMemory& memory) const {
  if (!request.trajectory || !params_.enabled) return;
  RequireSize(*request.trajectory, measured.size());
  const planning::BandSituation now{
      time,     request.trajectory, set.obstacles,
      measured, set.estimates,      left_out == nullptr ? nullptr : &left_out->pairs};
  const BandReport before = memory.report;
  replanner_.Follow(now, memory);
  replanner_.Plan(now, BeginOf(time, memory), rate, memory);
  Tell(time, memory.report, before, log);
}

}  // namespace oca::systems
