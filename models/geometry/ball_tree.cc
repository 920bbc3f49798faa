// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ball_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "oca/models/geometry/near_balls.h"

namespace oca::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool Finite(const Ball& ball) { return ball.centre.allFinite() && std::isfinite(ball.radius); }

}  // namespace

void BallTree::Build(std::span<const Ball> balls, std::size_t capacity) {
  const std::size_t most = std::max(capacity, balls.size());
  const std::size_t leaves = (most + kLeaf - 1) / kLeaf;
  balls_.reserve(most);
  loose_.reserve(most);
  place_.reserve(most);
  order_.reserve(kLeaf * leaves);
  columns_.reserve(4 * kLeaf * leaves);
  nodes_.reserve(2 * leaves);

  balls_.assign(balls.begin(), balls.end());
  order_.clear();
  loose_.clear();
  place_.assign(balls_.size(), -1);
  nodes_.clear();
  columns_.clear();
  for (int i = 0; i < size(); ++i) (Finite(ball(i)) ? order_ : loose_).push_back(i);
  if (order_.empty()) return;
  BuildNode(0, static_cast<int>(order_.size()));
  order_.resize((order_.size() + kLeaf - 1) / kLeaf * kLeaf, -1);  // the last leaf may have gaps
  columns_.assign(4 * order_.size(), kInfinity);
  for (std::size_t place = 0; place < order_.size(); ++place) {
    if (order_[place] < 0) continue;
    place_[static_cast<std::size_t>(order_[place])] = static_cast<int>(place);
    const Ball& at = ball(order_[place]);
    double* const leaf = columns_.data() + 4 * (place / kLeaf * kLeaf) + place % kLeaf;
    for (int axis = 0; axis < 3; ++axis) leaf[axis * kLeaf] = at.centre[axis];
    leaf[3 * kLeaf] = at.radius;
  }
}

int BallTree::BuildNode(int first, int last) {
  const int self = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  Enclose(first, last, node);
  if (last - first <= kLeaf) {
    node.first = first;
    node.right = -1;
  } else {
    Vector3d low = ball(order_[static_cast<std::size_t>(first)]).centre, high = low;
    for (int i = first; i < last; ++i) {
      const Vector3d& centre = ball(order_[static_cast<std::size_t>(i)]).centre;
      low = low.cwiseMin(centre);
      high = high.cwiseMax(centre);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    // A multiple of a leaf's size nearest to the half, so that all leaves but the last are full.
    const int half = std::max(kLeaf, (last - first + kLeaf) / (2 * kLeaf) * kLeaf);
    const int middle = std::min(first + half, last - 1);
    std::nth_element(
        order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int a, int b) {
          return std::pair(ball(a).centre[axis], a) < std::pair(ball(b).centre[axis], b);
        });
    node.first = -1;
    BuildNode(first, middle);
    node.right = BuildNode(middle, last);
  }
  node.skip = static_cast<int>(nodes_.size());
  nodes_[static_cast<std::size_t>(self)] = node;
  return self;
}

void BallTree::Enclose(int first, int last, Node& node) const {
  node.low.setConstant(kInfinity);
  node.high.setConstant(-kInfinity);
  for (int i = first; i < last; ++i) {
    const Ball& at = ball(order_[static_cast<std::size_t>(i)]);
    node.low = node.low.cwiseMin((at.centre.array() - at.radius).matrix());
    node.high = node.high.cwiseMax((at.centre.array() + at.radius).matrix());
  }
  node.centre = 0.5 * (node.low + node.high);
  node.radius = 0.0;
  for (int i = first; i < last; ++i) {
    const Ball& at = ball(order_[static_cast<std::size_t>(i)]);
    node.radius = std::max(node.radius, (at.centre - node.centre).norm() + at.radius);
  }
  // The last digits of what was computed here must not cut anything off.
  const double slack = 1e-14 * (node.centre.cwiseAbs().maxCoeff() + node.radius);
  node.radius += slack;
  node.low.array() -= slack;
  node.high.array() += slack;
}

void BallTree::Move(int index, const Ball& ball) {
  const auto at = static_cast<std::size_t>(index);
  balls_[at] = ball;
  if (place_[at] < 0) return;  // it is loose already
  const auto place = static_cast<std::size_t>(place_[at]);
  columns_[4 * (place / kLeaf * kLeaf) + place % kLeaf] = kInfinity;
  place_[at] = -1;
  loose_.push_back(index);
}

void BallTree::FindNear(const Vector3d& point, double reach, std::vector<int>& found) const {
  static_assert(kLeaf == internal::kBallsOfLeaf);
  const std::size_t before = found.size();
  for (const int index : loose_) {
    const Ball& at = ball(index);
    const double sum = reach + at.radius;
    if (!((at.centre - point).squaredNorm() > sum * sum)) found.push_back(index);
  }
  const int end = static_cast<int>(nodes_.size());
  const double reach2 = reach * reach;
  for (int i = 0; i < end;) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    const Vector3d gap = (node.low - point).cwiseMax(point - node.high).cwiseMax(0.0);
    if (gap.squaredNorm() > reach2) {
      i = node.skip;
      continue;
    }
    ++i;
    if (node.first < 0) continue;
    const double* const leaf = columns_.data() + 4 * static_cast<std::size_t>(node.first);
    unsigned near = internal::NearBalls(leaf, point, reach);
    for (; near != 0; near &= near - 1) {
      const int place = node.first + std::countr_zero(near);
      found.push_back(order_[static_cast<std::size_t>(place)]);
    }
  }
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end());
}

}  // namespace oca::geometry
