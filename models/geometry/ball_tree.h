// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace oca::geometry {

/// A ball around something; m. The radius may be infinite.
struct Ball {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};
  double radius{0.0};
};

/// Balls arranged such that those near a place are found without a look at the others.
///
/// A binary tree of bounding boxes over the balls as Build saw them, split at the median of the
/// longest side. A ball that moves leaves the tree for a list that every search looks through: it
/// costs a test from then on, and the tree is never rebuilt in between. Which balls a search finds
/// depends on where they are alone, not on how they came there.
class BallTree {
 public:
  /// Starts anew with these balls, numbered as they come, and takes memory for `capacity` of them:
  /// up to so many no later call touches the heap.
  void Build(std::span<const Ball> balls, std::size_t capacity = 0);
  /// Puts ball `index` elsewhere. No heap.
  void Move(int index, const Ball& ball);

  int size() const { return static_cast<int>(balls_.size()); }
  const Ball& ball(int index) const { return balls_[static_cast<std::size_t>(index)]; }

  /// Appends the numbers of all balls that come within `reach` (m, >= 0) of `point`, ascending; a
  /// ball that is not finite counts as near. No heap if `found` has room for all.
  void FindNear(const Eigen::Vector3d& point, double reach, std::vector<int>& found) const;

  /// Looks for what is nearest by some measure: calls `visit(index)` for the balls of each group
  /// that may hold something nearer than `limit()`, nearer groups first. `bound(centre, radius)` is
  /// a lower bound of the measure for all that lies in such a ball. No heap.
  template <class Bound, class Limit, class Visit>
  void Search(const Bound& bound, const Limit& limit, const Visit& visit) const;

 private:
  static constexpr int kLeaf = 8;
  struct Node {
    Eigen::Vector3d low, high;  // box around the balls
    Eigen::Vector3d centre;     // of a ball around them
    double radius;
    int first;  // of the leaf's places; -1 for an inner node, whose children are next and `right`
    int right;
    int skip;  // the node after this one and all below it
  };

  int BuildNode(int first, int last);
  void Enclose(int first, int last, Node& node) const;

  std::vector<Ball> balls_;
  std::vector<Node> nodes_;
  std::vector<int> order_;  // of the balls in the leaves; kLeaf places a leaf, -1 for none
  std::vector<int> place_;  // of each ball in the leaves; -1 for a loose one
  std::vector<int> loose_;
  std::vector<double> columns_;  // x, y, z and radius of kLeaf places, leaf after leaf
};

template <class Bound, class Limit, class Visit>
void BallTree::Search(const Bound& bound, const Limit& limit, const Visit& visit) const {
  for (const int index : loose_) visit(index);
  if (nodes_.empty()) return;
  struct Waiting {
    double bound;
    int node;
  };
  std::array<Waiting, 64> stack;  // a median split is never deeper
  int top = 0;
  stack[0] = {bound(nodes_[0].centre, nodes_[0].radius), 0};
  while (top >= 0) {
    const Waiting next = stack[static_cast<std::size_t>(top--)];
    if (next.bound > limit()) continue;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.first >= 0) {
      for (int place = node.first; place < node.first + kLeaf; ++place) {
        const int index = order_[static_cast<std::size_t>(place)];
        if (index >= 0 && place_[static_cast<std::size_t>(index)] == place) visit(index);
      }
      continue;
    }
    const auto waiting = [&](int child) {
      const Node& at = nodes_[static_cast<std::size_t>(child)];
      return Waiting{bound(at.centre, at.radius), child};
    };
    Waiting near = waiting(next.node + 1), far = waiting(node.right);
    if (far.bound < near.bound) std::swap(near, far);
    stack[static_cast<std::size_t>(++top)] = far;
    stack[static_cast<std::size_t>(++top)] = near;
  }
}

}  // namespace oca::geometry
