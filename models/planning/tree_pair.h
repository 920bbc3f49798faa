// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "oca/models/planning/search_tree.h"
#include "oca/models/random.h"
#include "oca/models/robot/robot_model.h"

namespace oca::planning {

/// Where a search draws positions: within the joints' limits; of a joint without, within half a
/// turn of both ends.
struct SearchRoom {
  SearchRoom(const robot::RobotModel& model, const Eigen::VectorXd& start,
             const Eigen::VectorXd& goal);
  Eigen::VectorXd Draw(models::Random& random) const;

  Eigen::VectorXd lower, upper;
};

/// Edges of a search are no longer than this (2-norm of the joints, rad and m).
inline constexpr double kLongestEdge = 0.7;
/// Samples of a search's edges are at first this far apart, and half as far, down to the least,
/// whenever they have misled. Eight, which are looked at at once, are those of an edge.
inline constexpr double kSampleSpacing = kLongestEdge / 8.0;
inline constexpr double kLeastSampleSpacing = kSampleSpacing / 8.0;
/// m; that samples keep besides the margin, so that what is between them can mostly be proved.
inline constexpr double kSampleRoom = 0.003;

/// Two trees, from a start and from a goal, that grow towards each other. A value.
/// source Kuffner, LaValle, RRT-Connect: An Efficient Approach to Single-Query Path Planning, 2000
class TreePair {
 public:
  using Path = std::vector<Eigen::VectorXd>;

  TreePair() = default;
  /// The goal's tree may be empty, `goal` null: then nothing is met.
  TreePair(const Eigen::VectorXd& start, const Eigen::VectorXd* goal);

  int size() const { return from_start.size() + from_goal.size(); }

  /// One tree grows by an edge towards q, then the other as far as it can towards the new node, by
  /// edges no longer than `step` until both have `most` nodes; whether they meet. Samples keep
  /// room() besides the margin.
  bool Grow(const Eigen::VectorXd& q, double step, int most, CertifiedMotion& motion);
  /// The path through where they met just now, if it is proved clear; else what is not is cut off,
  /// and samples are closer from now on.
  std::optional<Path> Prove(CertifiedMotion& motion);

  double spacing() const { return spacing_; }
  double room() const { return room_; }
  /// From now on samples keep up to `most` (m) besides the margin, as far as both positions do.
  void LeaveRoom(CertifiedMotion& motion, const Eigen::VectorXd& start, const Eigen::VectorXd& goal,
                 double most = kSampleRoom);

  SearchTree from_start, from_goal;

 private:
  bool start_grows_{true};
  double spacing_{kSampleSpacing};
  double room_{0.0};
  int start_node_{0}, goal_node_{0};  // where they met
};

}  // namespace oca::planning
