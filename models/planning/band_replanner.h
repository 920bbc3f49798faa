// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/motion/trajectory.h"
#include "oca/models/planning/band_memory.h"
#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/standing_changes.h"
#include "oca/models/robot/clear_motion.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

struct ReplanSettings {
  BandPlannerSettings planner{};
  double plan_time{0.02};        ///< s; that there is to make a plan
  double plan_budget{0.0};       ///< s; that a plan's work may count as, about; 0: all that time
  double prediction{2.0};        ///< s; how long obstacles are taken to go on as now
  double restart_distance{0.1};  ///< rad, m; of arm and band above which plans start from the arm
  double stuck_time{2.0};        ///< s; without progress, after which the arm is stuck
  double stuck_motion{0.01};     ///< rad, m; what counts as progress
  bool self_collision{false};
  std::string own_prefix{};                    ///< of own links' names in BandSituation::ignored
  double self_distance{robot::kSelfDistance};  ///< m; that own links keep; 0: as from obstacles
  std::uint64_t seed{0};
};

/// What is known at an instant; everything of `n` joints.
struct BandSituation {
  using Positions = Eigen::Ref<const Eigen::VectorXd>;
  double time{0.0};  ///< s
  const std::shared_ptr<const motion::Trajectory>& request;
  const std::vector<geometry::Obstacle>& obstacles;
  Positions measured;  ///< where the arm is
  /// One an obstacle, or none: then these are known exactly.
  std::span<const geometry::ObstacleEstimate> estimates{};
  /// Pairs whose distance does not count: a link, and a body or a link of the robot, the latter
  /// named by `own_prefix` and its name. Null: none.
  const std::vector<std::pair<models::Name, models::Name>>* ignored{nullptr};
};

/// Plans bands one after the other along a request, for an arm that follows them among obstacles
/// that are taken to go on for `prediction` as is likely (planning::LikelyAhead) and then to stay:
/// straight, unless they were estimated to accelerate, or their velocity changes from plan to plan.
/// Distances to what was estimated count less by what it is uncertain.
///
/// A plan begins with the state that the band before it has at that time, or with the arm, if that
/// is farther than restart_distance from where the band says. The first eight plans look for
/// shorter ways even if theirs is clear; after them a plan whose obstacles still stand where they
/// stood is kept, as long as it goes on to the end of the request, or for half of most_horizon.
/// What it knows from plan to plan is the BandMemory.
/// source docs/explanation/recommended.md
class BandReplanner {
 public:
  BandReplanner(std::shared_ptr<const robot::RobotModel> model, const ReplanSettings& settings);

  /// Whether the arm gets on, into `moved` and `stuck`: it is stuck if the request rests, its goal
  /// is not reached to 0.01 and for stuck_time the arm was not nearer to it by stuck_motion than
  /// ever before, nor had a plan that leads there.
  void Follow(const BandSituation& now, BandMemory& memory) const;

  /// For how long the next plan may be made before it begins, s: plan_time, or what one that was
  /// late has taken.
  double TimeToPlan(const BandMemory& memory) const;

  /// Makes the plan that begins at `start` (s), unless the last one is kept, or one is still being
  /// made. `rate` is the arm's velocity, 0 if it is not known. Allocates if it plans.
  ///
  /// The plan's work is counted and priced (PlanPrices). If it counts as more time than there is up
  /// to `start` the plan is late: it is thrown away, the band before it goes on, for no band could
  /// begin in a state that was not known when it was planned; nothing else is planned while it
  /// would have been made, and the next one gets a quarter more time than it took, from the same
  /// memory.
  void Plan(const BandSituation& now, double start,
            const std::optional<BandSituation::Positions>& rate, BandMemory& memory) const;

  /// For how long the bands are clear from now on, and of what; 0 while the arm is more than 0.005
  /// from `planned`, another motion is requested, or obstacles are not where they were foreseen,
  /// until a plan that was made for them has begun.
  void TellClear(const BandSituation& now, const BandSituation::Positions& planned,
                 const BandMemory& memory, robot::ClearMotion& motion) const;

 private:
  /// For how long what was seen at the last plan is foreseen to go on, s.
  double Since(double time, const BandMemory& memory) const;
  /// Whether the plan goes on to the request's end, or for long enough.
  bool Covers(const BandSituation& now, const BandMemory& memory) const;
  bool Kept(const BandSituation& now, BandMemory& memory) const;
  bool Astray(const BandSituation& now, BandMemory& memory) const;
  using Estimates = std::span<const geometry::ObstacleEstimate>;
  std::vector<BandBody> MakeBodies(const BandSituation& now, Estimates estimates) const;
  /// What an estimate adds to a body of an obstacle at a time.
  void Estimate(double time, const geometry::Obstacle& obstacle,
                const geometry::ObstacleEstimate& estimate, BandBody& body) const;
  /// Forgets what was found for another goal or among other bodies at rest.
  void Forget(const BandSituation& now, BandMemory& memory) const;
  /// From the request's goal to where the arm is to end; empty if that is the goal.
  Eigen::VectorXd EndFor(const BandSituation& now, const BandMemory& memory) const;
  /// What a plan came to, but for its curve.
  void Note(const BandPlan& found, BandMemory& memory) const;
  void MakePlan(const BandSituation& now, double start,
                const std::optional<BandSituation::Positions>& rate, BandMemory& memory) const;
  void GiveWay(const BandSituation& now, const BandPlan& found, BandMemory& memory) const;
  void IgnoreOwnLinks(const BandSituation& now, BandPlanner& planner) const;
  BandTask MakeTask(const BandSituation& now, double start, std::span<const BandBody> bodies,
                    const std::optional<BandSituation::Positions>& rate, BandMemory& memory) const;

  const std::shared_ptr<const robot::RobotModel> model_;
  const ReplanSettings settings_;
  const ReachBall reach_;
  robot::Clearance arm_;
};

}  // namespace oca::planning
