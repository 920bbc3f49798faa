// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/tree_pair.h"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "oca/models/robot/joint_limits.h"

namespace oca::planning {
SearchRoom::SearchRoom(const robot::RobotModel& model, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& goal)
    : lower(model.lower_limits()), upper(model.upper_limits()) {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (robot::HasOwnRange(model, i)) continue;
    lower[i] = std::max(lower[i], std::min(start[i], goal[i]) - std::numbers::pi);
    upper[i] = std::min(upper[i], std::max(start[i], goal[i]) + std::numbers::pi);
  }
}

Eigen::VectorXd SearchRoom::Draw(models::Random& random) const {
  Eigen::VectorXd q(lower.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = random.Uniform(lower[i], upper[i]);
  return q;
}

TreePair::TreePair(const Eigen::VectorXd& start, const Eigen::VectorXd* goal) : from_start(start) {
  if (goal != nullptr) from_goal = SearchTree(*goal);
}

void TreePair::LeaveRoom(CertifiedMotion& motion, const Eigen::VectorXd& start,
                         const Eigen::VectorXd& goal, double most) {
  room_ = motion.RoomOf(start, goal, most);
}

bool TreePair::Grow(const Eigen::VectorXd& q, double step, int most, CertifiedMotion& motion) {
  SearchTree& growing = start_grows_ ? from_start : from_goal;
  SearchTree& other = start_grows_ ? from_goal : from_start;
  const bool grew = growing.Grow(q, {step, spacing_, room_, most - other.size()}, 1, motion).grew;
  bool met = false;
  if (grew) {
    const Eigen::VectorXd meeting = growing.q(growing.last());
    met = other.Grow(meeting, {step, spacing_, room_, most - growing.size()}, most, motion).arrived;
    if (met) {
      const int at = other.Nearest(meeting);
      start_node_ = start_grows_ ? growing.last() : at;
      goal_node_ = start_grows_ ? at : growing.last();
    }
  }
  // The smaller tree grows, unless it is shut in.
  start_grows_ = grew ? from_start.size() <= from_goal.size() : !start_grows_;
  return met;
}

std::optional<TreePair::Path> TreePair::Prove(CertifiedMotion& motion) {
  const bool proved = from_start.Prove(start_node_, motion);
  if (!from_goal.Prove(goal_node_, motion) || !proved) {
    spacing_ = std::max(0.5 * spacing_, kLeastSampleSpacing);
    return std::nullopt;
  }
  Path path = from_start.PathTo(start_node_);
  const Path back = from_goal.PathTo(goal_node_);
  path.insert(path.end(), std::next(back.rbegin()), back.rend());  // the meeting point once
  return path;
}

}  // namespace oca::planning
