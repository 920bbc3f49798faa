// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <span>

#include "oca/models/name.h"
#include "oca/models/robot/proximity.h"

namespace oca::robot {

/// A point of a link and one of an obstacle that were the nearest ones of the two lately.
struct WitnessPair {
  models::Name link{};
  models::Name obstacle{};
  Eigen::Vector3d point_on_link{Eigen::Vector3d::Zero()};      ///< in the link's frame, m
  Eigen::Vector3d point_on_obstacle{Eigen::Vector3d::Zero()};  ///< world; own links: their frame
  double age{0.0};                                             ///< since they were the nearest, s

  bool IsOf(const Proximity& proximity) const {
    return link == proximity.link && obstacle == proximity.obstacle;
  }
};

/// The nearest points of near bodies in the last kKept seconds. Where a flat lies along a flat the
/// nearest points of one tick are at one end and those of the next at the other: who keeps only the
/// nearest ones apart loses what the far end comes nearer, tick by tick. Any two points, one of
/// each body, are at least as far apart as the bodies, so keeping these apart too asks for nothing
/// that the distance does not.
///
/// An obstacle moves on with the velocity at its nearest point; that it turns is left out, which
/// bounds how long a pair of points is worth something.
class WitnessPairs {
 public:
  static constexpr int kMost = 64;      ///< those seen last
  static constexpr int kOfABody = 4;    ///< of one link and one obstacle
  static constexpr double kKept = 0.5;  ///< s

  std::span<const WitnessPair> pairs() const {
    return {pairs_.data(), static_cast<std::size_t>(count_)};
  }

  /// After `time` s: the obstacles of `set` have moved; what is too old, or of none of it, is
  /// forgotten.
  void Move(double time, const ProximitySet& set);
  /// Keeps the nearest points of `proximity`, which must be apart.
  void Keep(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
            const Proximity& proximity);

 private:
  void Remove(int pair) { pairs_[static_cast<std::size_t>(pair)] = pairs_[--count_]; }

  int count_{0};
  std::array<WitnessPair, kMost> pairs_{};
};

/// `proximity` between the two points of `pair`, which is one of the same bodies, instead of its
/// nearest ones.
Proximity Between(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                  const WitnessPair& pair, const Proximity& proximity);

}  // namespace oca::robot
