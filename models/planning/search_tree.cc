// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/search_tree.h"

#include <algorithm>
#include <limits>

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

SearchTree::Growth SearchTree::Grow(const Eigen::VectorXd& q, const Steps& steps,
                                    CertifiedMotion& motion) {
  int from = Nearest(q);
  bool grew = false;
  while (size() < steps.most) {
    const Eigen::VectorXd here = this->q(from);
    const Eigen::VectorXd way = q - here;
    const double length = way.norm();
    if (length == 0.0) return {true, grew};
    const double share = std::min(1.0, steps.step / length);
    const Eigen::VectorXd next = share == 1.0 ? q : Eigen::VectorXd(here + share * way);
    double clear = motion.SampledShare(here, next, steps.spacing, steps.room);
    if (clear < 1.0) {  // how far from the last sample that is clear to the first that is not
      const Eigen::VectorXd last_clear = here + clear * share * way;
      const double rest = std::min(1.0 - clear, steps.spacing / (share * length));
      const Eigen::VectorXd not_clear = last_clear + rest * share * way;
      clear += rest * motion.SampledShare(last_clear, not_clear, steps.spacing / 8.0, steps.room);
    }
    if (clear < 1.0 && clear * share * length < kLeastProgress) return {false, grew};
    Add(clear == 1.0 ? next : Eigen::VectorXd(here + clear * share * way), from);
    from = last();
    grew = true;
    if (clear < 1.0 || share == 1.0) return {clear == 1.0, grew};
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
