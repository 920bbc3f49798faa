// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/witness_pairs.h"

#include <algorithm>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {
namespace {

// Points nearer than this to kept ones, on both bodies, are the same (m).
constexpr double kSamePoint = 1e-3;

/// Of the obstacle; the world's, if it is no own link.
Eigen::Isometry3d ObstacleFrame(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                                const Proximity& proximity) {
  if (proximity.own_link.empty()) return Eigen::Isometry3d::Identity();
  return X_WL[NumberOfLink(model, proximity.own_link)];
}

}  // namespace

void WitnessPairs::Move(double time, const ProximitySet& set) {
  for (int i = count_ - 1; i >= 0; --i) {
    WitnessPair& pair = pairs_[static_cast<std::size_t>(i)];
    pair.age += time;
    const auto proximity = std::find_if(set.proximities.begin(), set.proximities.end(),
                                        [&](const Proximity& other) { return pair.IsOf(other); });
    if (pair.age > kKept || proximity == set.proximities.end()) {
      Remove(i);
    } else if (proximity->own_link.empty()) {
      pair.point_on_obstacle += time * proximity->obstacle_velocity;
    }
  }
}

void WitnessPairs::Keep(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                        const Proximity& proximity) {
  WitnessPair added{proximity.link, proximity.obstacle};
  const Eigen::Isometry3d& X_WLink = X_WL[NumberOfLink(model, proximity.link)];
  added.point_on_link = X_WLink.inverse() * proximity.point_on_link;
  added.point_on_obstacle =
      ObstacleFrame(model, X_WL, proximity).inverse() * proximity.point_on_obstacle;
  int of_bodies = 0, oldest_of_bodies = 0, oldest = 0;
  for (int i = 0; i < count_; ++i) {
    WitnessPair& pair = pairs_[static_cast<std::size_t>(i)];
    if (pair.age > pairs_[static_cast<std::size_t>(oldest)].age) oldest = i;
    if (!pair.IsOf(proximity)) continue;
    if ((pair.point_on_link - added.point_on_link).norm() < kSamePoint &&
        (pair.point_on_obstacle - added.point_on_obstacle).norm() < kSamePoint) {
      pair = added;
      return;
    }
    if (of_bodies++ == 0 || pair.age > pairs_[static_cast<std::size_t>(oldest_of_bodies)].age) {
      oldest_of_bodies = i;
    }
  }
  if (of_bodies == kOfABody) {
    Remove(oldest_of_bodies);
  } else if (count_ == kMost) {
    Remove(oldest);
  }
  pairs_[static_cast<std::size_t>(count_++)] = added;
}

Proximity Between(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                  const WitnessPair& pair, const Proximity& proximity) {
  Proximity between = proximity;
  between.point_on_link = X_WL[NumberOfLink(model, pair.link)] * pair.point_on_link;
  between.point_on_obstacle = ObstacleFrame(model, X_WL, proximity) * pair.point_on_obstacle;
  const Eigen::Vector3d apart = between.point_on_link - between.point_on_obstacle;
  between.distance = apart.norm();
  between.normal = apart / between.distance;
  return between;
}

}  // namespace oca::robot
