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
#include "oca/models/planning/band_report.h"
#include "oca/models/planning/obstacle_prediction.h"
#include "oca/models/planning/path_search.h"

namespace oca::planning {

/// Until when a band can be trusted, s.
struct BandTrust {
  double all{0.0};       ///< of everything
  double standing{0.0};  ///< of what stands, and own links
};

/// What is held of bands between one plan and the next.
struct BandMemory {
  BandReport report{};                                  ///< of the last plan
  BandCurve held{};                                     ///< up to report.change
  BandCurve next{};                                     ///< from then on; empty: held goes on
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

  std::shared_ptr<const motion::Trajectory> followed{};  ///< the request that `moved` is about
  double nearest_away{0.0};   ///< rad, m; least of the largest distances of a joint from the goal
  double moved{0.0};          ///< s; when it last fell, or a plan led there
  double off_since{0.0};      ///< s; since when the arm is not on its band
  Eigen::VectorXd planned{};  ///< where it should be at the last plan
  int failures{0};            ///< plans in a row that were not clear, or do not reach the goal

  double lead{0.0};        ///< s; that the next plan has at least, after one that was late
  double busy_until{0.0};  ///< s; before then no other plan is begun

  /// The band at a time; before the first plan empty.
  const BandCurve& At(double t) const { return !next.empty() && t >= report.change ? next : held; }
};

}  // namespace oca::planning
