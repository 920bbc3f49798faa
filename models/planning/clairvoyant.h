// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "models/planning/band_planner.h"

namespace oca::models {

/// A task whose every body is known for all its time.
struct ClairvoyantTask {
  BandRequest request{};
  double request_end{0.0};  ///< s
  double duration{0.0};     ///< s; the arm rests at the request at time 0
  std::span<const BandBody> bodies{};
  std::uint64_t seed{0};
  int starts{30};  ///< that are relaxed, beside the request and the paths
};

struct ClairvoyantPlan {
  bool clear{false};         ///< min_distance > 0, within the limits
  double min_distance{0.0};  ///< m; on a grid of 1 ms, up to kClairvoyantReach
  double speed{0.0};         ///< largest share of a velocity limit; 0 without limits
  double acceleration{0.0};
  BandStart start{BandStart::kRequest};
  BandCurve curve{};
};

inline constexpr double kClairvoyantReach = 0.05;  ///< m

/// What an optimiser can do offline that knows the whole script: a BandPlanner whose band is fine
/// from start to end, with many starts, judged on a grid of its own. A scenario that it clears can
/// be cleared within the limits of the joints; one that it does not clear perhaps too.
ClairvoyantPlan PlanClairvoyantly(const std::shared_ptr<const RobotModel>& model,
                                  const ClairvoyantTask& task);

}  // namespace oca::models
