// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "oca/models/motion/stoppable_motion.h"
#include "oca/models/name.h"
#include "oca/models/qp/projection_qp.h"

namespace oca::robot {

/// One bound that held a BarrierFilter's velocity back, or that it had to leave out: kUnmovable is
/// a distance that should grow and that no joint can change.
struct FilterBound {
  enum class Kind { kDistance, kRecovery, kLower, kUpper, kUnmovable };
  Kind kind{Kind::kDistance};
  models::Name link{};      ///< of a distance; of a side of the box the joint
  models::Name obstacle{};  ///< of a distance
  motion::MotionLimit limit{motion::MotionLimit::kNone};  ///< of a side of the box
  double multiplier{0.0};                                 ///< what one unit of the bound costs, > 0
  double slack{0.0};                                      ///< m/s by which a row is not kept
};

/// What a BarrierFilter did at one tick, and how far it can be trusted.
/// Any other status than "optimal" means that the arm brakes.
struct FilterActivity {
  static constexpr int kMostBounds = 24;

  qp::QpStatus status{qp::QpStatus::kOptimal};
  int rows{0};         ///< that could matter within the box
  int dropped{0};      ///< for want of room; those farthest away
  int yields{0};       ///< joints of which a position or velocity limit cannot be kept
  double slack{0.0};   ///< m/s; the largest of a distance row
  double margin{0.0};  ///< m; how far below safe_distance ticks may lead, see BarrierFilter
  double kkt_residual{0.0};
  double gap{0.0};
  int num_bounds{0};
  std::array<FilterBound, kMostBounds> bounds{};  ///< the first num_bounds

  /// As long as there is room.
  void Add(const FilterBound& bound) {
    if (num_bounds < kMostBounds) bounds[static_cast<std::size_t>(num_bounds++)] = bound;
  }
};

}  // namespace oca::robot
