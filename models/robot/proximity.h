// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "oca/models/name.h"

namespace oca::robot {

class RobotModel;

/// Nearest points of one link and one obstacle. `distance` is signed (negative: penetration);
/// `normal` is the unit vector from the obstacle to the link.
struct Proximity {
  models::Name link{};
  models::Name obstacle{};
  double distance{0.0};
  Eigen::Vector3d point_on_link{Eigen::Vector3d::Zero()};
  Eigen::Vector3d point_on_obstacle{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitX()};
  /// Velocity of the obstacle at point_on_obstacle, m/s.
  Eigen::Vector3d obstacle_velocity{Eigen::Vector3d::Zero()};
  /// The link that the obstacle is, if it is one of the same robot, else empty. Its motion is that
  /// of the robot's own joints, so obstacle_velocity is 0 and the row of the distance takes two
  /// links: see DistanceRow.
  models::Name own_link{};
  /// Bound on the speed of all points of the obstacle, m/s; 0 for an own link.
  double obstacle_speed{0.0};
  /// The most that may be asked of this distance, m, of own links: OwnRanges. Who keeps a distance
  /// keeps no more than this here, and what begins to act at one begins here, in proportion.
  double range{std::numeric_limits<double>::infinity()};
};

/// What all distances shrink by at a pair, at most 1: its range as a share of `reach` (m), from
/// where on it would count.
inline double RangeShare(const Proximity& proximity, double reach) {
  return std::min(proximity.range / reach, 1.0);
}

/// What is not listed is farther than `max_distance` (m; 0: unknown) and no faster than `fastest`
/// (m/s). `compared` says whether any pair was looked at, listed or not: if none was, the set tells
/// nothing.
struct ProximitySet {
  std::vector<Proximity> proximities{};
  double max_distance{0.0};
  double fastest{0.0};
  bool compared{false};
};

/// The number of a link that a proximity names. throws ModelError if the model has no such link
int NumberOfLink(const RobotModel& model, models::Name link);

/// d(distance)/d(position) of every joint, into `row` of num_positions() entries. throws ModelError
/// if it is of no link of the model
void DistanceRow(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                 const Proximity& proximity, Eigen::Ref<Eigen::VectorXd> row);

}  // namespace oca::robot
