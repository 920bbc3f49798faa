// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "oca/models/robot/link_colliders.h"
#include "oca/models/robot/own_ranges.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// A solid and where it is in the world.
struct PlacedBody {
  std::shared_ptr<const geometry::Collider> collider;
  Eigen::Isometry3d X_WO{Eigen::Isometry3d::Identity()};
};

/// A link and what is near it: a body, or another link of the robot.
struct NearPair {
  double distance{kUnlimited};  ///< signed, m, as it counts; unlimited: nothing is that near
  int link{-1};                 ///< number in the model
  int body{-1};                 ///< place in the list of bodies; -1: `other_link` it is
  int other_link{-1};
  Eigen::Vector3d point_on_link{Eigen::Vector3d::Zero()};  ///< world axes
  Eigen::Vector3d point_on_other{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitX()};  ///< from the other to the link
  double scale{1.0};  ///< of the distance as it counts to what it is: see Clearance::KeepOwn
};

/// Signed distances of a robot at given joint positions to bodies in the world, for planners.
///
/// Links that no joint moves are left out: what they touch, no motion can change. Pairs of the
/// robot's own links count if `self_collision`, but for those that are adjacent or disabled in the
/// model. It holds one position: one a thread. Once made, no heap, except where a vector of the
/// caller grows.
class Clearance {
 public:
  /// throws ModelError for a solid that MakeCollider refuses
  explicit Clearance(std::shared_ptr<const RobotModel> model, bool self_collision = false,
                     std::vector<PlacedBody> bodies = {});

  const RobotModel& model() const { return *model_; }
  const std::vector<PlacedBody>& bodies() const { return bodies_; }
  void SetBodies(std::vector<PlacedBody> bodies) {
    bodies_ = std::move(bodies);
    ignored_.clear();
  }
  /// Leaves a pair out from now on: a link and a body, by their numbers.
  void Ignore(int link, int body) { ignored_.emplace_back(link, body); }
  /// Leaves two links of the robot out from now on, by their numbers in either order.
  void IgnoreOwn(int link, int other);
  /// Moves body number `body`, of a scene in which time goes on.
  void MoveBody(int body, const Eigen::Isometry3d& X_WO) { bodies_[body].X_WO = X_WO; }

  /// From now on the distance of a pair of own links counts `reference` / range times, where its
  /// range is less than `reference` (m): who asks all pairs for `reference` asks this one for its
  /// range, and what he looks at beyond is nearer too in that proportion.
  void KeepOwn(const OwnRanges& ranges, double reference);

  /// Brings the robot to q (num_positions()); all else speaks of this position.
  void MoveTo(const Eigen::Ref<const Eigen::VectorXd>& q);
  std::span<const Eigen::Isometry3d> X_WL() const { return X_WL_; }

  /// Whether anything is nearer than `margin` (m); returns at the first pair found.
  bool NearerThan(double margin) const;
  /// The nearest pair of all; its distance is kUnlimited if none is within `max_distance`.
  NearPair Nearest(double max_distance = kUnlimited) const;
  /// All pairs within `max_distance`, behind each other in `pairs`, which is cleared.
  void Collect(double max_distance, std::vector<NearPair>& pairs) const;
  /// The least distance of each link to any body, or `max_distance` where that is less; `least`
  /// has num_links().
  void LinkDistances(double max_distance, std::span<double> least) const;
  /// The same of the pairs of own links, in m whatever they count; `least` has an entry a pair.
  void OwnDistances(double max_distance, std::span<double> least) const;
  /// The pairs of own links that count, as numbers of links.
  const std::vector<std::pair<int, int>>& own_pairs() const { return own_pairs_; }
  /// How many times the distance of each counts.
  const std::vector<double>& own_scales() const { return own_scales_; }
  /// The derivative of the pair's distance, as it counts, by the joint positions: row has
  /// num_positions().
  void Gradient(const NearPair& pair, Eigen::Ref<Eigen::VectorXd> row) const;

 private:
  template <class Visit>
  void ForEach(double max_distance, const Visit& visit) const;
  geometry::SignedDistance OwnDistance(std::size_t pair, double max_distance) const;
  bool Ignored(int link, int body) const;

  std::shared_ptr<const RobotModel> model_;
  std::vector<LinkCollider> links_;
  std::vector<std::pair<int, int>> own_pairs_;   // numbers of links
  std::vector<std::pair<int, int>> own_places_;  // the same as places in links_
  std::vector<double> own_scales_;               // one a pair
  std::vector<PlacedBody> bodies_;
  std::vector<std::pair<int, int>> ignored_;  // link, body
  std::vector<Eigen::Isometry3d> X_WL_;
};

}  // namespace oca::robot
