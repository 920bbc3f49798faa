// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/search_tree.h"

#include <algorithm>
#include <iterator>

namespace oca::planning {
namespace {

// A piece of an edge shorter than this is not worth a node, rad.
constexpr double kLeastProgress = 0.02;

}  // namespace

int SearchTree::Nearest(const Eigen::VectorXd& q) const {
  int nearest = 0;
  double least = (this->q(0) - q).squaredNorm();
  for (int i = 1; i < size(); ++i) {
    const double distance = (this->q(i) - q).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

void SearchTree::Add(const Eigen::VectorXd& q, int parent) {
  size_of_q_ = q.size();
  positions_.insert(positions_.end(), q.data(), q.data() + q.size());
  parents_.push_back(parent);
}

SearchTree::Growth SearchTree::Grow(const Eigen::VectorXd& q, double step, int most,
                                    CertifiedMotion& motion) {
  int from = Nearest(q);
  bool grew = false;
  while (size() < most) {
    const Eigen::VectorXd here = this->q(from);
    const Eigen::VectorXd way = q - here;
    const double length = way.norm();
    if (length == 0.0) return {true, grew};
    const double share = std::min(1.0, step / length);
    const Eigen::VectorXd next = share == 1.0 ? q : Eigen::VectorXd(here + share * way);
    const double clear = motion.ClearShare(here, next);
    const bool whole = clear == 1.0 && (share < 1.0 || motion.Clear(next));
    if (!whole && 0.9 * clear * share * length < kLeastProgress) return {false, grew};
    Add(whole ? next : Eigen::VectorXd(here + 0.9 * clear * share * way), from);
    from = last();
    grew = true;
    if (!whole || share == 1.0) return {whole, grew};
  }
  return {false, grew};
}

void SearchTree::AddRoot(const Eigen::VectorXd& q, int child) {
  Add(q, -1);
  int parent = last();
  for (int node = child; node >= 0;) {  // all edges up to the old root turn round
    const int next = parents_[static_cast<std::size_t>(node)];
    parents_[static_cast<std::size_t>(node)] = parent;
    parent = node;
    node = next;
  }
  // The root is asked for as number 0.
  const auto first = positions_.begin();
  std::swap_ranges(first, first + size_of_q_, positions_.end() - size_of_q_);
  std::swap(parents_.front(), parents_.back());
  for (int& other : parents_) {
    if (other == 0) {
      other = last();
    } else if (other == last()) {
      other = 0;
    }
  }
}

std::vector<Eigen::VectorXd> SearchTree::PathTo(int node) const {
  std::vector<Eigen::VectorXd> path;
  for (; node >= 0; node = parents_[static_cast<std::size_t>(node)]) path.emplace_back(q(node));
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<Eigen::VectorXd> JoinPaths(const SearchTree& from_start, int start_node,
                                       const SearchTree& from_goal, int goal_node) {
  std::vector<Eigen::VectorXd> path = from_start.PathTo(start_node);
  const std::vector<Eigen::VectorXd> back = from_goal.PathTo(goal_node);
  path.insert(path.end(), std::next(back.rbegin()), back.rend());  // the meeting point once
  return path;
}

}  // namespace oca::planning
