// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "oca/models/name.h"
#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/plan_work.h"

namespace oca::planning {

/// Why a goal cannot be had.
enum class BandBlock {
  kNone,
  kLimit,    ///< it is beyond a limit of a joint
  kContact,  ///< something is in it
  kWay,      ///< no way there was found
};
inline constexpr std::array kBandBlockNames{"none", "limit", "contact", "way"};

/// What the last plan of a BandReplanner came to.
struct BandReport {
  std::uint64_t plans{0};  ///< that were made so far
  double change{0.0};      ///< s; from then on its band is followed
  BandStart start{BandStart::kRequest};
  bool clear{true};
  bool reaches{true};     ///< it ends at the goal
  int level{0};           ///< see BandPlan
  double kept{0.0};       ///< m; least distance of what stands where less than is wanted is kept
  double goal_room{0.0};  ///< m; that the goal leaves, at most clear_distance
  BandLack lack{BandLack::kNone};  ///< what leaves less than the margin where it is nearest
  /// That clear plans came nearer than hard_distance, where start or goal leave no more; false
  /// again once one keeps twice as much.
  bool tight{false};
  bool stuck{false};     ///< no progress to the goal for stuck_time; link and obstacle say why
  double nearest{0.0};   ///< m; the least distance foreseen, as it counts, or the margin
  double distance{0.0};  ///< m; the same as it is
  models::Name link{};   ///< the pair, empty if it is the margin
  models::Name obstacle{};
  double time{0.0};  ///< s; of the nearest
  double cost{0.0};
  BandBlock block{BandBlock::kNone};
  models::Name block_link{};  ///< the pair, or the joint whose limit it is
  models::Name block_body{};
  double block_amount{0.0};   ///< m that it is deep or away, rad or m beyond the limit
  PlanWork work{};            ///< whether it was late or not
  double charged{0.0};        ///< s; what that counts as
  std::uint64_t overruns{0};  ///< plans that took longer than they had

  void Unblock() {
    block = BandBlock::kNone;
    block_link = block_body = {};
    block_amount = 0.0;
  }
};

}  // namespace oca::planning
