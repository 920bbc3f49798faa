// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/planning/band_replanner.h"
#include "oca/systems/signals/band_signals.h"
#include "oca/systems/signals/clear_motion.h"
#include "oca/systems/signals/ignored_pairs.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/request_ahead.h"
#include "oca/systems/signals/roles.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Bends the requested motion around what stands and moves, in time: an elastic band in space and
/// time, planned anew every plan_period, whose place in time a SafetyFilter then follows.
///
///     position = request(t) + x(t),   x the deviation of planning::BandOptimizer
///
/// A plan looks ahead to the end of the request and a little further, at least least_horizon. It
/// takes every obstacle to go on as it does now for `prediction` seconds and then to stay; of one
/// that a tracker estimated it takes what it is likely to do (planning::LikelyAhead), and counts
/// the distance less by what its place is uncertain. Of one whose velocity nobody knows it takes
/// the place alone, and trusts no plan. It begins plan_time after the instant that it is made at,
/// which is the time there is to compute it, from the state that the band before it then has:
/// position, velocity and acceleration are continuous. The simulated clock is charged: the work of
/// a plan is counted and priced by plan_cost, the same on every machine; one that counts as more
/// than plan_time is late, is thrown away, and while it would have been made nothing else is
/// planned; the next one begins as much later as that one took and a quarter more. A warning is
/// logged for the first, `plan.overruns` counts them. If the arm is farther than restart_distance
/// from where the band says, the next band starts from the arm. The first eight plans look for
/// shorter ways even if theirs is clear; after them a plan whose obstacles still stand where they
/// stood is kept.
///
/// One distance is hard: no plan comes nearer than hard_distance to what stands, nor own links to
/// each other, at any time; a start or a goal that is nearer, but clear, lowers it there to its
/// own, with a warning. clear_distance and margin are wishes: they yield to goal, start and
/// passages.
///
/// `clear` says for how long the motion is clear from now on: until the plan comes nearer than it
/// must to what stands (hard_distance, or trust_distance if the plan is not clear), flying_distance
/// to what moves, or exceeds a limit that the request keeps. It is 0 while the arm is more than
/// 0.005 from the band, another motion is requested, or obstacles are not where they were foreseen,
/// to 5 mm now and in 0.3 s, until a plan that was made for them has begun; what stands where it
/// stood is known all the same, if the arm is within 0.001 of a band that passes nearer than 0.01
/// m. A SafetyFilter lets such a motion through.
///
/// Control samples are those of the end of each period, held, as from a sampled SplineGenerator.
///
/// Own links are asked for their own distance, robot::OwnRangesAlong of self_distance and the
/// request: clear_distance stands for it, and margin and trust_distance for as many times it.
///
/// A goal beyond limits is taken to the limit. Before one in contact, or to which no way is found,
/// the arm rests as near as the search has come, until what stands changes, or the request; a
/// warning says what blocks, and by how much.
///
/// The arm counts as stuck if the request rests, the goal is not reached to 0.01 and for stuck_time
/// the arm was nowhere nearer to it by stuck_motion, nor had a plan that leads there; `plan` then
/// names the pair that is nearest, and a warning is logged.
///
/// Plans allocate; control samples do not, nor does a tick at which a plan is kept.
///
/// in    ahead              RequestAhead  the requested motion; without one the arm is to rest
///       obstacles          ObstacleSet   all that it plans around: BulletDistance::around
///       measured_position  n  u
///       measured_velocity  n  u/s        optional; absent counts as 0
///       ignored            IgnoredPairs  optional; pairs whose distance does not count
/// out   position      n  u
///       velocity      n  u/s
///       acceleration  n  u/s^2
///       plan          BandReport    of the last plan
///       clear         ClearMotion
/// state position, velocity, acceleration  n
///       plan          BandMemory
/// throws ConfigError if there is no such model, a parameter is out of its bounds, or plan_period
///        is shorter than period; while running if the request has another number of joints
/// source models/planning/band_replanner.h; docs/explanation/recommended.md
class ElasticBand final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "bends the requested motion around what stands and moves, ahead of time",
      "position = request + x, x = argmin integral of clearance max(margin - distance, 0)^2 + "
      "nearness x^2 + calm x'^2 + smoothness x''^2 + limits excess^2",
      "Quinlan, Khatib 1993, Elastic bands"};
  /// planning::PlanPrices as parameters.
  struct PlanCost {
    double plan{planning::PlanPrices{}.plan};
    double band{planning::PlanPrices{}.band};
    double exact{planning::PlanPrices{}.exact};
    double batch{planning::PlanPrices{}.batch};
    static void Describe(Fields<PlanCost>& fields);
  };
  struct Params {
    std::string model{};
    Period period{};
    Period plan_period{1, 50};
    double plan_time{0.0};
    double plan_budget{planning::ReplanSettings{}.plan_budget};
    PlanCost plan_cost{};
    double margin{planning::BandSettings{}.margin};
    double clear_distance{planning::BandSettings{}.clear_distance};
    double hard_distance{planning::BandSettings{}.hard_distance};
    double trust_distance{planning::BandSettings{}.trust_distance};
    double flying_distance{planning::BandSettings{}.flying_distance};
    double clearance{planning::BandSettings{}.clearance};
    double smoothness{planning::BandSettings{}.smoothness};
    double nearness{planning::BandSettings{}.nearness};
    double calm{planning::BandSettings{}.calm};
    double limit_share{planning::BandSettings{}.limit_share};
    double prediction{planning::ReplanSettings{}.prediction};
    int most_evaluations{4000};
    double moving_horizon{planning::BandPlannerSettings{}.moving_horizon};
    double least_horizon{planning::BandPlannerSettings{}.least_horizon};
    double most_horizon{planning::BandPlannerSettings{}.most_horizon};
    double restart_distance{planning::ReplanSettings{}.restart_distance};
    double stuck_time{planning::ReplanSettings{}.stuck_time};
    double stuck_motion{planning::ReplanSettings{}.stuck_motion};
    bool self_collision{false};
    double self_distance{planning::ReplanSettings{}.self_distance};
    int seed{0};
    bool enabled{true};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  ElasticBand(const Params& params, const ModelSet& models);

 private:
  static planning::ReplanSettings SettingsOf(const Params& params, const ModelSet& models);
  void CalcClear(double time, const RequestAhead& request, const ObstacleSet& set,
                 VectorView measured, VectorView planned, const BandMemory& memory,
                 ClearMotion& motion) const;
  void Start(VectorView measured, MutableVectorView position_out) const;
  /// Warns of what is new.
  void Tell(double time, const BandReport& report, const BandReport& before, Log& log) const;
  const char* UnitOf(models::Name joint) const;
  std::optional<Obstruction> WhatBlocks(const BandReport& report) const;
  /// When a plan that is made at `time` begins: at the first tick after which it is there.
  double BeginOf(double time, const BandMemory& memory) const;
  void Plan(double time, Log& log, const RequestAhead& request, const ObstacleSet& set,
            VectorView measured, std::optional<VectorView> rate, const IgnoredPairs* left_out,
            BandMemory& memory) const;
  void Sample(double time, const RequestAhead& request, const BandMemory& memory,
              MutableVectorView next_position, MutableVectorView next_velocity,
              MutableVectorView next_acceleration) const;

  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const planning::BandReplanner replanner_;
  const DiscreteState<Vector> position_;
  const DiscreteState<Vector> velocity_;
  const DiscreteState<Vector> acceleration_;
  const DiscreteState<BandMemory> memory_;

 public:
  const Input<RequestAhead> ahead;
  const Input<ObstacleSet> obstacles;
  const Input<Vector> measured_position;
  const OptionalInput<Vector> measured_velocity;
  const OptionalInput<IgnoredPairs> ignored;
  const Output<Vector> position;
  const Output<Vector> velocity;
  const Output<Vector> acceleration;
  const Output<BandReport> plan;
  const Output<ClearMotion> clear;
};

}  // namespace oca::systems
