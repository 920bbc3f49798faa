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

namespace oca::planning {

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
  double held_until{0.0};  ///< s; at which held or next leave less than trust_distance
  double next_until{0.0};
  double moved{0.0};          ///< s; when the arm was last seen to get on
  Eigen::VectorXd resting{};  ///< where it was then
  Eigen::VectorXd planned{};  ///< where it should be at the last plan
  int failures{0};            ///< plans in a row that were not clear

  std::uint64_t plans{0};  ///< that were made so far
  BandStart start{BandStart::kRequest};
  bool clear{true};
  bool stuck{false};     ///< no progress to the goal for stuck_time; link and obstacle say why
  double nearest{0.0};   ///< m; the least distance foreseen, as it counts, or the margin
  double distance{0.0};  ///< m; the same as it is
  models::Name link{};   ///< the pair, empty if it is the margin
  models::Name obstacle{};
  double time{0.0};  ///< s; of the nearest
  double cost{0.0};
  std::uint64_t evaluations{0};  ///< configurations that the last plan looked at

  /// The band at a time; before the first plan empty.
  const BandCurve& At(double t) const { return !next.empty() && t >= change ? next : held; }
};

}  // namespace oca::planning
