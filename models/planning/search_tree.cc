// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/search_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace oca::planning {
namespace {

// A piece of an edge shorter than this is not worth a node, rad.
constexpr double kLeastProgress = 0.02;

}  // namespace

int SearchTree::Nearest(const Eigen::VectorXd& q) const {
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const double* at = positions_.data();
  for (int i = 0; i < size(); ++i, at += size_of_q_) {
    double distance = 0.0;
    for (Eigen::Index j = 0; j < size_of_q_; ++j) distance += (at[j] - q[j]) * (at[j] - q[j]);
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

SearchTree::Edge SearchTree::EdgeFrom(int node, const Eigen::VectorXd& q, double step) const {
  Eigen::VectorXd here = this->q(node);
  const double length = (q - here).norm();
  if (length <= step) return {std::move(here), q, length, true};
  Eigen::VectorXd to = here + step / length * (q - here);
  return {std::move(here), std::move(to), step, false};
}

SearchTree::Growth SearchTree::Grow(const Eigen::VectorXd& q, const Steps& steps, int edges,
                                    CertifiedMotion& motion) {
  int from = Nearest(q);
  for (int grown = 0; size() < steps.most; ++grown) {
    const Edge edge = EdgeFrom(from, q, steps.step);
    if (edge.length == 0.0) return {true, grown > 0};
    if (grown == edges || !motion.SamplesClear(edge.from, edge.to, steps.spacing, steps.room)) {
      return {false, grown > 0};
    }
    Add(edge.to, from);
    from = last();
    if (edge.arrives) return {true, true};
  }
  return {false, false};
}

SearchTree::Growth SearchTree::GrowUntilBlocked(const Eigen::VectorXd& q, const Steps& steps,
                                                CertifiedMotion& motion) {
  int from = Nearest(q);
  bool grew = false;
  while (size() < steps.most) {
    const Edge edge = EdgeFrom(from, q, steps.step);
    if (edge.length == 0.0) return {true, grew};
    const Eigen::VectorXd way = edge.to - edge.from;
    double clear = motion.SampledShare(edge.from, edge.to, steps.spacing, steps.room);
    if (clear < 1.0) {  // how far from the last sample that is clear to the first that is not
      const Eigen::VectorXd last_clear = edge.from + clear * way;
      const double rest = std::min(1.0 - clear, steps.spacing / edge.length);
      const Eigen::VectorXd not_clear = last_clear + rest * way;
      clear += rest * motion.SampledShare(last_clear, not_clear, steps.spacing / 8.0, steps.room);
    }
    if (clear < 1.0 && clear * edge.length < kLeastProgress) return {false, grew};
    Add(clear == 1.0 ? edge.to : Eigen::VectorXd(edge.from + clear * way), from);
    from = last();
    grew = true;
    if (clear < 1.0 || edge.arrives) return {clear == 1.0, grew};
  }
  return {false, grew};
}

bool SearchTree::Prove(int node, CertifiedMotion& motion) {
  std::vector<int> way;
  for (; node > 0; node = parents_[static_cast<std::size_t>(node)]) way.push_back(node);
  for (auto at = way.rbegin(); at != way.rend(); ++at) {
    if (motion.ClearShare(q(parents_[static_cast<std::size_t>(*at)]), q(*at)) == 1.0) continue;
    CutOff(*at);
    return false;
  }
  return true;
}

void SearchTree::CutOff(int node) {
  std::vector<int> place(parents_.size(), -1);  // of those that stay
  std::vector<bool> stays(parents_.size());
  for (int i = 0; i < size(); ++i) {
    int at = i;
    while (at > 0 && at != node) at = parents_[static_cast<std::size_t>(at)];
    stays[static_cast<std::size_t>(i)] = at != node;
  }
  int count = 0;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (stays[i]) place[i] = count++;
  }
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (!stays[i]) continue;
    const int to = place[i];
    std::copy_n(positions_.begin() + static_cast<std::ptrdiff_t>(i) * size_of_q_, size_of_q_,
                positions_.begin() + to * size_of_q_);
    const int parent = parents_[i];
    parents_[static_cast<std::size_t>(to)] =
        parent < 0 ? -1 : place[static_cast<std::size_t>(parent)];
  }
  parents_.resize(static_cast<std::size_t>(count));
  positions_.resize(static_cast<std::size_t>(count * size_of_q_));
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

}  // namespace oca::planning
