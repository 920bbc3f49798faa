// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/motion_judge.h"

namespace oca::planning {

/// A task whose every body is known for all its time.
struct ClairvoyantTask {
  BandRequest request{};
  double request_end{0.0};  ///< s
  double duration{0.0};     ///< s
  Eigen::VectorXd start{};  ///< where the arm rests at time 0; empty: at the request
  std::span<const BandBody> bodies{};
  bool self_collision{false};
  robot::OwnRanges own{};  ///< what the search asks of own links; the judgement asks for no contact
  /// Links and bodies, by their numbers, that may touch. The search keeps them apart where it can,
  /// the judgement does not look at them.
  std::span<const std::pair<int, int>> ignored{};
  std::uint64_t seed{0};
  int starts{30};  ///< tries beside the request and what BandPlanner finds
};

struct ClairvoyantPlan {
  MotionVerdict verdict{};               ///< every kMotionGrid
  BandStart start{BandStart::kRequest};  ///< that led to it; kRandom: bent where it failed
  int tries{0};  ///< that it took; 0: the request itself, from where the arm is
  BandCurve curve{};
};

inline constexpr double kClairvoyantReach = 0.05;  ///< m

/// What an optimiser can do offline that knows the whole script.
///
/// A motion counts if MotionJudge finds it clear and within the limits; that, and not what a band
/// costs, says when the search is over. It tries
///
/// 1. the request;
/// 2. the request relaxed, under ever higher prices of the limits: a band pays for exceeding them,
///    and is content with that where it is cheaper than a way around;
/// 3. `starts` times the best motion so far or the request, bent at random where it fails, and
///    relaxed likewise. Where the end is in the way of something, half of these may end elsewhere;
/// 4. after a few of them what a BandPlanner finds, with pauses, detours and paths of RrtConnect.
///
/// What it clears can be cleared within the limits of the joints; what it does not clear perhaps
/// too, unless the arm is in contact at the start, where the search ends at once. The answer is a
/// function of the task.
/// throws ModelError if the task has no length, or its start not that of the positions
ClairvoyantPlan PlanClairvoyantly(const std::shared_ptr<const robot::RobotModel>& model,
                                  const ClairvoyantTask& task);

}  // namespace oca::planning
