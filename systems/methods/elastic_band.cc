// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/elastic_band.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/log.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/methods/obstacle_prediction.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

using Eigen::VectorXd;

constexpr double kArrived = 0.01;          // rad, m; of all joints
constexpr double kOnPlan = 0.005;          // rad, m; of the arm
constexpr std::uint64_t kFreshPlans = 8;   // that look for a better way though theirs is clear
constexpr double kLongestHorizon = 600.0;  // s; a plan looks at 2.5 to 20 places a second
constexpr int kMostPause = 20;             // plans between two searches that fail

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

}  // namespace

void ElasticBand::Params::Describe(Fields<Params>& fields) {
  fields.Add("model", &Params::model, "", "name of the robot; may be left out if there is but one");
  fields.Add("period", &Params::period, "s", "control period").Above(0.0).Required();
  fields.Add("plan_period", &Params::plan_period, "s", "time between plans, and to make one")
      .Above(0.0);
  fields.Add("margin", &Params::margin, "m", "distance up to which obstacles push the band")
      .Above(0.0);
  fields
      .Add("clear_distance", &Params::clear_distance, "m",
           "distance that a band keeps that counts as clear; above the filter's safe_distance")
      .Above(0.0);
  fields
      .Add("trust_distance", &Params::trust_distance, "m",
           "distance that a band keeps from what stands that a filter need not correct")
      .AtLeast(0.0);
  fields
      .Add("flying_distance", &Params::flying_distance, "m",
           "distance that a band keeps from what moves that a filter need not correct")
      .AtLeast(0.0);
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
  fields.Add("stuck_motion", &Params::stuck_motion, "rad", "what counts as progress").Above(0.0);
  fields.Add("self_collision", &Params::self_collision, "", "keeps own links apart too");
  fields.Add("seed", &Params::seed, "", "of the random starts");
  fields.Add("enabled", &Params::enabled, "", "false: the request as it is");
}

planning::BandPlannerSettings ElasticBand::SettingsOf(const Params& params) {
  planning::BandPlannerSettings settings;
  settings.band.margin = params.margin;
  settings.band.clear_distance = params.clear_distance;
  settings.band.trust_distance = params.trust_distance;
  settings.band.flying_distance = params.flying_distance;
  settings.band.clearance = params.clearance;
  settings.band.smoothness = params.smoothness;
  settings.band.calm = params.calm;
  settings.band.nearness = params.nearness;
  settings.band.limit_share = params.limit_share;
  settings.most_evaluations = params.most_evaluations;
  settings.moving_horizon = params.moving_horizon;
  settings.least_horizon = params.least_horizon;
  settings.most_horizon = params.most_horizon;
  return settings;
}

ElasticBand::ElasticBand(const Params& params, const ModelSet& models)
    : params_(Checked(params)),
      model_(MovableModel(models, params.model)),
      position_(DeclareDiscreteState("position", PositionSpec(*model_), 0.0)),
      velocity_(DeclareDiscreteState("velocity", RateSpec(*model_), 0.0)),
      acceleration_(DeclareDiscreteState(
          "acceleration", {model_->num_positions(), RateSpec(*model_).unit.Rate()}, 0.0)),
      memory_(DeclareDiscreteState("plan", BandMemory{})),
      ahead(DeclareInput<RequestAhead>("ahead")),
      obstacles(DeclareInput<ObstacleSet>("obstacles")),
      measured_position(DeclareInput<Vector>("measured_position", PositionSpec(*model_))),
      measured_velocity(DeclareOptionalInput<Vector>("measured_velocity", RateSpec(*model_))),
      position(DeclareStateOutput("position", position_)),
      velocity(DeclareStateOutput("velocity", velocity_)),
      acceleration(DeclareStateOutput("acceleration", acceleration_)),
      plan(DeclareStateOutput("plan", memory_)),
      clear(DeclareOutput<ClearMotion, &ElasticBand::CalcClear>(
          "clear", {}, kTime, ahead, obstacles, measured_position, position_, memory_)) {
  DeclareInitialization<&ElasticBand::Start>(Writes(position_), measured_position);
  DeclareUpdate<&ElasticBand::Sample>(
      Every{params_.period}, Writes(position_, velocity_, acceleration_), kTime, ahead, memory_);
  DeclareUpdate<&ElasticBand::Plan>(Every{params_.plan_period}, Writes(memory_), kTime, kLog, ahead,
                                    obstacles, measured_position, measured_velocity);
  if (!params_.enabled) return;
  DeclareRole(Limits{.shown = Limits::Shown::kBelow,
                     .signal = plan,
                     .bound = {params_.margin},
                     .member = "nearest",
                     .how = "bent around what is near",
                     .period = params_.plan_period});
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

double ElasticBand::Since(double time, const BandMemory& memory) const {
  return std::clamp(time - memory.seen_at, 0.0, params_.prediction);
}

void ElasticBand::CalcClear(double time, const RequestAhead& request, const ObstacleSet& set,
                            VectorView measured, VectorView planned, const BandMemory& memory,
                            ClearMotion& motion) const {
  motion.clear_for = 0.0;
  motion.own_links = params_.self_collision;
  motion.bodies.clear();
  for (const Obstacle& seen : memory.seen) motion.bodies.push_back(seen.body->id);
  if (request.trajectory != memory.request) return;
  const bool followed = (measured - planned).cwiseAbs().maxCoeff() <= kOnPlan;
  if (memory.plans == 0 || time < memory.sure_from || !followed ||
      !AsForeseen(memory.seen, set.obstacles, Since(time, memory))) {
    return;
  }
  const bool next = !memory.next.empty() && time >= memory.change;
  const double until = next ? memory.next_until : memory.held_until;
  motion.clear_for = std::clamp(until - time, 0.0, params_.most_horizon);
}

std::vector<planning::BandBody> ElasticBand::MakeBodies(double time, const ObstacleSet& set) const {
  std::vector<planning::BandBody> bodies;
  for (const Obstacle& obstacle : set.obstacles) {
    const bool stands = Stands(obstacle) || params_.prediction == 0.0;
    const auto pose = [obstacle, time, longest = params_.prediction, stands](double t) {
      return stands ? obstacle.X_WO : Foreseen(obstacle, std::clamp(t - time, 0.0, longest));
    };
    bodies.push_back({obstacle.body->id, obstacle.body->collider, pose, stands});
  }
  return bodies;
}

bool ElasticBand::Astray(double time, const motion::Trajectory* request, VectorView measured,
                         BandMemory& memory) const {
  memory.planned.resize(measured.size());
  request->Evaluate(time, 0, memory.planned);
  memory.At(time).Add(time, 0, memory.planned);
  return (measured - memory.planned).cwiseAbs().maxCoeff() > params_.restart_distance;
}

bool ElasticBand::Kept(double time, const RequestAhead& request, const ObstacleSet& set,
                       VectorView measured, BandMemory& memory) const {
  if (set.obstacles.empty() && !params_.self_collision && memory.held.empty() &&
      memory.next.empty()) {
    return true;
  }
  return (memory.plans >= kFreshPlans ||
          (memory.plans > 0 && memory.start == planning::BandStart::kRequest)) &&
         memory.clear && request.trajectory == memory.request &&
         SameStanding(memory.seen, set.obstacles) &&
         !Astray(time, request.trajectory.get(), measured, memory);
}

void ElasticBand::Follow(double time, const motion::Trajectory* request, VectorView measured,
                         BandMemory& memory) const {
  if (memory.resting.size() != measured.size() ||
      (measured - memory.resting).cwiseAbs().maxCoeff() > params_.stuck_motion ||
      time < request->times().back()) {
    memory.resting = measured;
    memory.moved = time;
  }
  const double away = (measured - request->goal()).cwiseAbs().maxCoeff();
  memory.stuck = away > kArrived && time - memory.moved >= params_.stuck_time;
}

void ElasticBand::Report(double time, const BandMemory& memory, Log& log) const {
  const std::string pair = memory.link.empty()
                               ? "nothing near"
                               : fmt::format("{} to {}, {:.3f} m", memory.link.text(),
                                             memory.obstacle.text(), memory.nearest);
  log.Write(LogLevel::kWarning, time,
            fmt::format("the arm is stuck: no progress to its goal for {} s; what blocks: {}",
                        params_.stuck_time, pair));
}

planning::BandTask ElasticBand::MakeTask(double time, const motion::Trajectory* request,
                                         const std::vector<planning::BandBody>& bodies,
                                         VectorView measured, OptionalVector rate,
                                         BandMemory& memory) const {
  planning::BandTask task;
  task.start = params_.plan_period.TickAfter(time);
  task.request = [request](double t, int derivative, Eigen::Ref<VectorXd> out) {
    request->Evaluate(t, derivative, out);
  };
  task.request_end = request->times().back();
  task.bodies = bodies;
  task.seed = static_cast<std::uint64_t>(params_.seed) + memory.plans;
  for (int d = 0; d < 3; ++d) {
    task.deviation[d].setZero(measured.size());
    if (!memory.held.empty()) memory.held.Evaluate(task.start, d, task.deviation[d]);
  }
  if (Astray(time, request, measured, memory)) {
    const VectorXd v = rate ? VectorXd(*rate) : VectorXd::Zero(measured.size());
    task.deviation[0] = measured + params_.plan_period.seconds() * v;
    task.deviation[0] -= request->Evaluate(task.start, 0);
    task.deviation[1] = v - request->Evaluate(task.start, 1);
    task.deviation[2].setZero();
  }
  const int pause = std::min(memory.failures, kMostPause);
  task.search = memory.plans;
  task.fresh = memory.plans < kFreshPlans;
  task.explore =
      planning::Moves(bodies) || pause < 3 || memory.plans % static_cast<std::uint64_t>(pause) == 0;
  return task;
}

void ElasticBand::Plan(double time, Log& log, const RequestAhead& request, const ObstacleSet& set,
                       VectorView measured, OptionalVector rate, BandMemory& memory) const {
  if (!request.trajectory || !params_.enabled) return;
  RequireSize(*request.trajectory, measured.size());
  const bool was_stuck = memory.stuck;
  Follow(time, request.trajectory.get(), measured, memory);
  if (memory.stuck && !was_stuck) Report(time, memory, log);
  if (Kept(time, request, set, measured, memory)) return;
  const bool foreseen = memory.plans > 0 && request.trajectory == memory.request &&
                        AsForeseen(memory.seen, set.obstacles, Since(time, memory)) &&
                        !Astray(time, request.trajectory.get(), measured, memory);
  if (!memory.next.empty()) {
    memory.held = memory.next;
    memory.held_until = memory.next_until;
  }
  const auto bodies = MakeBodies(time, set);
  const planning::BandTask task =
      MakeTask(time, request.trajectory.get(), bodies, measured, rate, memory);
  planning::BandPlanner planner(model_, SettingsOf(params_), params_.self_collision);
  planning::BandPlan found = planner.Plan(task, memory.held.empty() ? nullptr : &memory.held);
  memory.next = std::move(found.curve);
  memory.change = task.start;
  memory.next_until = found.check.touch;
  if (planning::Moves(bodies)) memory.next_until = std::min(memory.next_until, memory.next.end());
  if (!foreseen) memory.sure_from = task.start;
  memory.request = request.trajectory;
  memory.seen_at = time;
  memory.seen = set.obstacles;
  memory.plans += 1;
  memory.start = found.start;
  memory.clear = found.check.clear();
  memory.failures = memory.clear ? 0 : memory.failures + 1;
  memory.nearest = found.check.min_distance;
  memory.link = found.check.link;
  memory.obstacle = found.check.body;
  memory.time = found.check.time;
  memory.cost = found.cost;
  memory.evaluations = static_cast<std::uint64_t>(found.evaluations);
}

}  // namespace oca::systems
