// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "oca/models/planning/certified_motion.h"

namespace oca::planning {

/// A tree of configurations, each joined with its parent by a straight motion that is clear at
/// samples; what is to be used is proved, and what cannot be proved is cut off. Flat memory: copies
/// of one size do not allocate.
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
  /// How trees grow: edges are no longer than `step`, samples on them at most `spacing` apart and,
  /// besides the margin, `room` (m) clear; a tree has at most `most` nodes.
  struct Steps {
    double step, spacing, room;
    int most;
  };
  /// Grows from the nearest node towards q by at most `edges` edges, all samples of each of which
  /// are clear.
  Growth Grow(const Eigen::VectorXd& q, const Steps& steps, int edges, CertifiedMotion& motion);
  /// The same by any number of edges and a part of one: as far as the samples are clear.
  Growth GrowUntilBlocked(const Eigen::VectorXd& q, const Steps& steps, CertifiedMotion& motion);
  /// Whether the way from the root to a node is proved clear. If not, the first edge that is not is
  /// cut off, with all that is behind it: nodes get other numbers, but for the root.
  bool Prove(int node, CertifiedMotion& motion);

  /// Adds a root before the present one, joined with a node: the new root is number 0, what was
  /// number 0 is the last.
  void AddRoot(const Eigen::VectorXd& q, int child);
  /// From the root to a node.
  std::vector<Eigen::VectorXd> PathTo(int node) const;

 private:
  /// Towards q from a node, no longer than an edge.
  struct Edge {
    Eigen::VectorXd from, to;
    double length;
    bool arrives;
  };
  Edge EdgeFrom(int node, const Eigen::VectorXd& q, double step) const;
  void CutOff(int node);

  Eigen::Index size_of_q_{0};
  std::vector<double> positions_;
  std::vector<int> parents_;
};

}  // namespace oca::planning
