// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/srdf.h"

namespace oca::robot {

/// Why a pair of links need not be checked for collision, or that it must be; the first that holds.
/// source MoveIt Setup Assistant, compute_default_collisions.cpp, whose shares and reasons they
///        are; there what always collides counts as kDefault
enum class PairKind {
  kAdjacent,  ///< see RobotModel::adjacent
  kAlways,    ///< in collision at kAlwaysShare of the samples or more: by design
  kDefault,   ///< in collision at the posture 0, where an arm stands first: taken for by design
  kNever,     ///< no sample came nearer than the margin
  kSometimes  ///< must be checked
};
inline constexpr double kAlwaysShare = 0.95;
/// As SRDF files write it: "Adjacent", "Always", "Default", "Never", "Sometimes".
std::string_view ToString(PairKind kind);

struct CollisionSampling {
  int samples{10000};
  std::uint64_t seed{0};
  double margin{0.02};  // m; a pair that came nearer counts as one that may collide
  /// Told before each sample what share is done; false: it ends, and no pair is told of.
  std::function<bool(double share)> progress{};
};

/// One pair of links that have solids. `link_a` < `link_b` are link numbers.
struct LinkPairCheck {
  int link_a{0};
  int link_b{0};
  PairKind kind{PairKind::kSometimes};
  double least_distance{0.0};  // m, signed, over all samples
  int collisions{0};           // samples with distance <= 0
  bool at_zero{false};         // whether they touch at the posture 0
};

/// Looks at every pair of links with solids, adjacent ones too, at the posture 0 (or what is
/// nearest to it within the limits), which is the first of the samples, and at random positions
/// within the limits.
///
/// A quarter of all draws of a joint lie on one of its limits, where arms fold; one that turns and
/// has no limits, or too wide ones, is drawn from a whole turn (DrawnRange). The same seed gives
/// the same answer on every machine that rounds alike. What was never seen may still happen: the
/// margin, not the number of samples, is what makes "never" safe.
///
/// throws ModelError if samples < 1, the margin is negative or not finite, more than 500 links have
///        solids, a joint has no range that samples cover, a distance is not finite, or a solid
///        cannot be prepared for distance queries
std::vector<LinkPairCheck> CheckCollisions(const RobotModel& model,
                                           const CollisionSampling& sampling);

/// The pairs that need no check, for SaveDisabledPairs, one reason after the other.
std::vector<DisabledPair> PairsToDisable(const RobotModel& model,
                                         const std::vector<LinkPairCheck>& pairs);

}  // namespace oca::robot
