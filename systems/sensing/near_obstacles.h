// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "oca/models/geometry/ball_tree.h"
#include "oca/systems/sensing/link_colliders.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Balls around the obstacles of a set, arranged for searches, which follow the set: only what
/// moved is touched, unless bodies come or go.
class ObstacleScene {
 public:
  /// Takes over the set. No heap up to the largest capacity that a set had.
  void Follow(const ObstacleSet& set);
  std::size_t capacity() const { return kept_.capacity(); }
  const geometry::BallTree& balls() const { return balls_; }
  /// Bound on the speed of all points of all obstacles, m/s.
  double fastest() const { return fastest_; }
  /// Bound on what distances to any of them count for less, m: geometry::Uncertainty.
  double uncertainty() const { return uncertainty_; }

 private:
  bool SameBodies(const ObstacleSet& set) const;
  void Start(const ObstacleSet& set);
  void Move(int index, const Obstacle& obstacle);

  geometry::BallTree balls_;
  std::vector<Obstacle> kept_;  // as of the set that came last
  std::vector<geometry::Ball> start_;
  std::uint64_t layout_{0};
  double fastest_{0.0};
  double uncertainty_{0.0};
};

/// For each link the obstacles that may be near, by their place in the set, ascending.
class NearObstacles {
 public:
  /// Starts anew, with room for all pairs so that nothing that comes near allocates.
  void Clear(std::size_t links, std::size_t obstacles);
  /// Adds the list of the next link, whose ball has its centre at `centre` and reaches `reach` far.
  void Add(const geometry::BallTree& balls, const Eigen::Vector3d& centre, double reach);
  /// Adds an empty list.
  void AddNone() { ends_.push_back(static_cast<int>(obstacles_.size())); }

  std::size_t links() const { return ends_.size(); }
  std::span<const int> of(std::size_t link) const {
    const auto first = link == 0 ? 0u : static_cast<std::size_t>(ends_[link - 1]);
    return std::span(obstacles_).subspan(first, static_cast<std::size_t>(ends_[link]) - first);
  }

 private:
  std::vector<int> ends_;  // of the links' lists in obstacles_
  std::vector<int> obstacles_;
};

/// Bound on the speed of all points of a body in a ball (m, in its frame) at X_WB, whose origin
/// moves with the given twist; m/s.
double SpeedBound(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular,
                  const Eigen::Isometry3d& X_WB, const geometry::Ball& ball);
/// What counts for a speed of which nothing is known, m/s: nothing is proven by it.
inline constexpr double kAnySpeed = 1e6;
/// The same of an obstacle: at any time if its body knows, otherwise now; kAnySpeed if neither the
/// body nor the obstacle does.
double SpeedBound(const Obstacle& obstacle);

}  // namespace oca::systems
