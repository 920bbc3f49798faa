// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "oca/models/geometry/ball_tree.h"
#include "oca/models/robot/link_colliders.h"
#include "oca/models/robot/own_ranges.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// A solid and where it is in the world.
struct PlacedBody {
  std::shared_ptr<const geometry::Collider> collider;
  Eigen::Isometry3d X_WO{Eigen::Isometry3d::Identity()};
  /// Of its position, m^2: the distance along a normal counts less by geometry::Uncertainty.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
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

/// A pair that may be near: a link and a body, by their numbers, or (`body` -1) that own pair of
/// Clearance::own_pairs().
struct PairPlace {
  int link;
  int body;
  int own_pair;
};

/// A ball of those that together contain a link, in the link's frame, and the radius of one about
/// the same centre that the link contains; 0: none. m.
struct LinkBall {
  geometry::Ball ball;
  double inner;
};
/// A list for each of Clearance::links().
using LinkCovers = std::vector<std::vector<LinkBall>>;

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
  /// Whether pairs of own links count.
  bool self_collision() const { return self_collision_; }
  const std::vector<PlacedBody>& bodies() const { return bodies_; }
  void SetBodies(std::vector<PlacedBody> bodies) {
    bodies_ = std::move(bodies);
    ignored_.clear();
    ++version_;
  }
  /// Those of the links that have solids, in the model's order.
  const std::vector<LinkCollider>& links() const { return links_; }
  /// Balls that contain them, made when they are asked for first; copies share them.
  const LinkCovers& covers();
  /// Leaves a pair out from now on: a link and a body, by their numbers.
  void Ignore(int link, int body) {
    ignored_.emplace_back(link, body);
    ++version_;
  }
  /// What is left out.
  const std::vector<std::pair<int, int>>& ignored() const { return ignored_; }
  /// Leaves two links of the robot out from now on, by their numbers in either order.
  void IgnoreOwn(int link, int other);
  /// Moves body number `body`, of a scene in which time goes on.
  void MoveBody(int body, const Eigen::Isometry3d& X_WO) {
    bodies_[body].X_WO = X_WO;
    ++version_;
  }
  /// Another number whenever what is kept clear of, or how far, is another than it was.
  long version() const { return version_; }

  void SetCovariance(int body, const Eigen::Matrix3d& covariance) {
    bodies_[body].covariance = covariance;
    ++version_;
  }

  /// From now on the distance of a pair of own links counts `reference` / range times, where its
  /// range is less than `reference` (m): who asks all pairs for `reference` asks this one for its
  /// range, and what he looks at beyond is nearer too in that proportion.
  void KeepOwn(const OwnRanges& ranges, double reference);

  /// Brings the robot to q (num_positions()); all else speaks of this position.
  void MoveTo(const Eigen::Ref<const Eigen::VectorXd>& q);
  std::span<const Eigen::Isometry3d> X_WL() const { return X_WL_; }

  /// Whether anything is nearer than `margin` (m); returns at the first pair found.
  bool NearerThan(double margin) const;
  /// The signed distance of one pair, as it counts; kUnlimited if it exceeds `max_distance`: of a
  /// link and a body, by their numbers, and of the own pair of that place in own_pairs().
  double LinkDistance(int link, int body, double max_distance) const;
  double OwnPairDistance(std::size_t pair, double max_distance) const;
  /// The nearest pair of all; its distance is kUnlimited if none is within `max_distance`.
  NearPair Nearest(double max_distance = kUnlimited) const;
  /// All pairs within `max_distance`, behind each other in `pairs`, which is cleared.
  void Collect(double max_distance, std::vector<NearPair>& pairs) const;
  /// The same of some pairs alone; in their order.
  void Collect(double max_distance, std::span<const PairPlace> of,
               std::vector<NearPair>& pairs) const;
  /// The least distance of each link to any body, or `max_distance` where that is less; `least`
  /// has num_links().
  void LinkDistances(double max_distance, std::span<double> least) const;
  /// The same with a maximum of each link, that `least` holds at first.
  void LinkDistances(std::span<double> least) const;
  /// The same of the pairs of own links, in m whatever they count; `least` has an entry a pair.
  void OwnDistances(double max_distance, std::span<double> least) const;
  void OwnDistances(std::span<double> least) const;
  /// The pairs of own links that count, as numbers of links.
  const std::vector<std::pair<int, int>>& own_pairs() const { return own_pairs_; }
  /// How many times the distance of each counts.
  const std::vector<double>& own_scales() const { return own_scales_; }
  /// The derivative of the pair's distance, as it counts, by the joint positions: row has
  /// num_positions().
  void Gradient(const NearPair& pair, Eigen::Ref<Eigen::VectorXd> row) const;

 private:
  /// One pair, if it is within the limit.
  bool LookAt(const LinkCollider& link, int body, double max_distance, NearPair& pair) const;
  bool LookAtOwn(std::size_t own_pair, double max_distance, NearPair& pair) const;
  template <class Visit>
  void ForEach(double max_distance, const Visit& visit) const;
  geometry::SignedDistance BodyDistance(const LinkCollider& link, const PlacedBody& body,
                                        double max_distance) const;
  geometry::SignedDistance OwnDistance(std::size_t pair, double max_distance) const;
  bool Ignored(int link, int body) const;

  std::shared_ptr<const RobotModel> model_;
  bool self_collision_;
  std::vector<LinkCollider> links_;
  std::vector<int> places_;  // in links_ of each link of the model; -1: it has no solids
  std::vector<std::pair<int, int>> own_pairs_;   // numbers of links
  std::vector<std::pair<int, int>> own_places_;  // the same as places in links_
  std::vector<double> own_scales_;               // one a pair
  std::vector<PlacedBody> bodies_;
  std::vector<std::pair<int, int>> ignored_;  // link, body
  std::vector<Eigen::Isometry3d> X_WL_;
  std::shared_ptr<const LinkCovers> covers_;
  long version_{0};
};

}  // namespace oca::robot
