// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/near_obstacles.h"

#include <algorithm>
#include <cmath>

namespace oca::systems {
namespace {

// Added to every reach, so that the rounding of a ball's place hides no pair; the distance itself
// decides who is beyond.
constexpr double kSlack = 1e-9;  // m

geometry::Ball BallOf(const Obstacle& obstacle) {
  const geometry::Collider& collider = *obstacle.body->collider;
  return {obstacle.X_WO * collider.centre(), collider.bounding_radius()};
}

}  // namespace

double SpeedBound(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular,
                  const Eigen::Isometry3d& X_WB, const geometry::Ball& ball) {
  const double turning = angular.norm();
  if (turning == 0.0) return linear.norm();  // of what has no end, too
  return (linear + angular.cross(X_WB.linear() * ball.centre)).norm() + turning * ball.radius;
}

double SpeedBound(const Obstacle& obstacle) {
  if (!obstacle.velocity_known) {
    return obstacle.body->fastest > 0.0 ? obstacle.body->fastest : kAnySpeed;
  }
  const geometry::Collider& collider = *obstacle.body->collider;
  return std::max(obstacle.body->fastest,
                  SpeedBound(obstacle.linear, obstacle.angular, obstacle.X_WO,
                             {collider.centre(), collider.bounding_radius()}));
}

void ObstacleScene::Follow(const ObstacleSet& set) {
  uncertainty_ = 0.0;
  for (const ObstacleEstimate& estimate : set.estimates) {
    const double variance = estimate.covariance.topLeftCorner<3, 3>().trace();
    uncertainty_ = std::max(uncertainty_, geometry::kConfidence * std::sqrt(variance));
  }
  const auto& obstacles = set.obstacles;
  if (set.layout != 0 && set.layout == layout_ && obstacles.size() == kept_.size()) {
    fastest_ = 0.0;
    for (const int i : set.moving) {
      const Obstacle& obstacle = obstacles[static_cast<std::size_t>(i)];
      fastest_ = std::max(fastest_, SpeedBound(obstacle));
      Move(i, obstacle);
    }
    return;
  }
  layout_ = set.layout;
  if (!SameBodies(set)) Start(set);
  fastest_ = 0.0;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    fastest_ = std::max(fastest_, SpeedBound(obstacle));
    if (obstacle.X_WO.matrix() != kept_[i].X_WO.matrix()) Move(static_cast<int>(i), obstacle);
  }
}

bool ObstacleScene::SameBodies(const ObstacleSet& set) const {
  return std::equal(set.obstacles.begin(), set.obstacles.end(), kept_.begin(), kept_.end(),
                    [](const Obstacle& a, const Obstacle& b) { return a.body == b.body; });
}

void ObstacleScene::Start(const ObstacleSet& set) {
  const std::size_t most = std::max(capacity(), set.obstacles.capacity());
  kept_.reserve(most);
  start_.reserve(most);
  kept_ = set.obstacles;
  start_.clear();
  for (const Obstacle& obstacle : kept_) start_.push_back(BallOf(obstacle));
  balls_.Build(start_, most);
}

void ObstacleScene::Move(int index, const Obstacle& obstacle) {
  kept_[static_cast<std::size_t>(index)].X_WO = obstacle.X_WO;
  balls_.Move(index, BallOf(obstacle));
}

void NearObstacles::Clear(std::size_t links, std::size_t obstacles) {
  ends_.clear();
  ends_.reserve(links);
  obstacles_.clear();
  obstacles_.reserve(links * obstacles);
}

void NearObstacles::Add(const geometry::BallTree& balls, const Eigen::Vector3d& centre,
                        double reach) {
  balls.FindNear(centre, reach + kSlack, obstacles_);
  AddNone();
}

}  // namespace oca::systems
