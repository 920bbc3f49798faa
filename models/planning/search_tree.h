// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "oca/models/planning/certified_motion.h"

namespace oca::planning {

/// A tree of configurations, each joined with its parent by a straight motion that was proved
/// clear. Flat memory: copies of one size do not allocate.
class SearchTree {
 public:
  using Positions = Eigen::Map<const Eigen::VectorXd>;

  SearchTree() = default;
  explicit SearchTree(const Eigen::VectorXd& root) { Add(root, -1); }

  bool empty() const { return parents_.empty(); }
  int size() const { return static_cast<int>(parents_.size()); }
  int last() const { return size() - 1; }
  Positions q(int node) const {
    return {positions_.data() + static_cast<std::ptrdiff_t>(node) * size_of_q_, size_of_q_};
  }
  int Nearest(const Eigen::VectorXd& q) const;
  void Add(const Eigen::VectorXd& q, int parent);

  /// What a growth came to: whether it arrived, and whether it got on.
  struct Growth {
    bool arrived;
    bool grew;
  };
  /// Grows from the nearest node towards q by edges of at most `step`, as far as it is clear and
  /// the tree has fewer than `most` nodes.
  Growth Grow(const Eigen::VectorXd& q, double step, int most, CertifiedMotion& motion);

  /// Adds a root before the present one, joined with a node: the new root is number 0, what was
  /// number 0 is the last.
  void AddRoot(const Eigen::VectorXd& q, int child);
  /// From the root to a node.
  std::vector<Eigen::VectorXd> PathTo(int node) const;

 private:
  Eigen::Index size_of_q_{0};
  std::vector<double> positions_;
  std::vector<int> parents_;
};

/// From the root of one tree to a node, and on from a node of another at the same place to its root.
std::vector<Eigen::VectorXd> JoinPaths(const SearchTree& from_start, int start_node,
                                       const SearchTree& from_goal, int goal_node);

}  // namespace oca::planning
