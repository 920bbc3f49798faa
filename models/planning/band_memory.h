// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/motion/trajectory.h"
#include "oca/models/name.h"
#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/obstacle_prediction.h"
#include "oca/models/planning/path_search.h"

namespace oca::planning {

/// Why a goal cannot be had.
enum class BandBlock {
  kNone,
  kLimit,    ///< it is beyond a limit of a joint
  kContact,  ///< something is in it
  kWay,      ///< no way there was found
};
inline constexpr std::array kBandBlockNames{"none", "limit", "contact", "way"};

/// Until when a band can be trusted, s.
struct BandTrust {
  double all{0.0};       ///< of everything
  double standing{0.0};  ///< of what stands, and own links
};

/// What is held of bands between one plan and the next, and what the last plan came to.
struct BandMemory {
  BandCurve held{};                                     ///< up to `change`
  BandCurve next{};                                     ///< from then on; empty: held goes on
  double change{0.0};                                   ///< s
  std::shared_ptr<const motion::Trajectory> request{};  ///< that next was made for
  robot::OwnRanges own{};                               ///< of that request
  std::vector<geometry::Obstacle> seen{};
  std::vector<geometry::ObstacleEstimate> seen_estimates{};
  VelocityChanges changes{};
  double seen_at{0.0};     ///< s
  double sure_from{0.0};   ///< s; from then on the bands were made for what is seen
  BandTrust held_until{};  ///< s; at which held or next come nearer than they are to
  BandTrust next_until{};
  std::vector<models::Name> still{};  ///< that stood before the last plan as now

  PathSearch search{};     ///< past what stands, from plan to plan
  Eigen::VectorXd rest{};  ///< where the arm is to rest short of a goal that it cannot reach
  BandBlock block{BandBlock::kNone};
  models::Name block_link{};  ///< the pair, or the joint whose limit it is
  models::Name block_body{};
  double block_amount{0.0};  ///< m that it is deep or away, rad or m beyond the limit

  std::shared_ptr<const motion::Trajectory> followed{};  ///< the request that `moved` is about
  double nearest_away{0.0};   ///< rad, m; least of the largest distances of a joint from the goal
  double moved{0.0};          ///< s; when it last fell, or a plan led there
  double off_since{0.0};      ///< s; since when the arm is not on its band
  Eigen::VectorXd planned{};  ///< where it should be at the last plan
  int failures{0};            ///< plans in a row that were not clear, or do not reach the goal

  std::uint64_t plans{0};  ///< that were made so far
  BandStart start{BandStart::kRequest};
  bool clear{true};
  bool reaches{true};     ///< the last plan ends at the goal
  int level{0};           ///< of kClearLevels, see BandPlan
  double kept{0.0};       ///< m; least distance of what stands where less than is wanted is kept
  double goal_room{0.0};  ///< m; that the goal leaves, at most clear_distance
  BandLack lack{BandLack::kNone};  ///< what leaves less than the margin where it is nearest
  /// That clear plans came nearer than hard_distance, where start or goal leave no more; false again
  /// once one keeps twice as much.
  bool tight{false};
  bool stuck{false};     ///< no progress to the goal for stuck_time; link and obstacle say why
  double nearest{0.0};   ///< m; the least distance foreseen, as it counts, or the margin
  double distance{0.0};  ///< m; the same as it is
  models::Name link{};   ///< the pair, empty if it is the margin
  models::Name obstacle{};
  double time{0.0};  ///< s; of the nearest
  double cost{0.0};
  PlanWork work{};            ///< of the last plan, whether it was late or not
  double charged{0.0};        ///< s; what that counts as
  std::uint64_t overruns{0};  ///< plans that took longer than they had
  double lead{0.0};           ///< s; that the next plan has at least, after one that was late
  double busy_until{0.0};     ///< s; before then no other plan is begun

  void Unblock() {
    block = BandBlock::kNone;
    block_link = block_body = {};
    block_amount = 0.0;
  }
  /// The band at a time; before the first plan empty.
  const BandCurve& At(double t) const { return !next.empty() && t >= change ? next : held; }
};

}  // namespace oca::planning
