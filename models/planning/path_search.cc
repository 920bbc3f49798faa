// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "oca/models/qp/projection_solver.h"
#include "oca/models/random.h"
#include "oca/models/robot/joint_limits.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kEdge = 0.5;           // rad; longest edge
constexpr double kSameGoal = 1e-9;      // rad
constexpr int kApproachTurn = 8;        // of so many draws one goes for what is near the goal
constexpr int kDescents = 30;           // steps down towards the goal
constexpr double kDescentStep = 0.15;   // rad, m; of a joint
constexpr double kDescentReach = 0.15;  // m; what is farther does not bind a step
constexpr double kDescentRoom = 5e-4;   // m; that a step keeps above the margin
constexpr int kMostRows = 60;
constexpr double kRowPenalty = 1e4;
constexpr int kBallTries = 40;
constexpr int kMoveTries = 5;  // nodes near a new start that a motion may lead to

/// The joints' ranges; a joint without one, within half a turn of both ends.
void RoomOf(const robot::RobotModel& model, const VectorXd& start, const VectorXd& goal,
            VectorXd& lower, VectorXd& upper) {
  lower = model.lower_limits();
  upper = model.upper_limits();
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (robot::HasOwnRange(model, i)) continue;
    lower[i] = std::max(lower[i], std::min(start[i], goal[i]) - std::numbers::pi);
    upper[i] = std::min(upper[i], std::max(start[i], goal[i]) + std::numbers::pi);
  }
}

}  // namespace

struct PathSearch::Tools {
  Tools(robot::Clearance& all, double keep, std::uint64_t seed)
      : clearance(all), margin(keep), motion(all, keep), random(seed) {}
  robot::Clearance& clearance;
  const double margin;
  CertifiedMotion motion;
  models::Random random;
  VectorXd lower, upper;
  std::vector<robot::NearPair> pairs;
};

bool PathSearch::IsFor(const VectorXd& goal) const {
  return state_ != State::kIdle && goal_.size() == goal.size() &&
         (goal_ - goal).cwiseAbs().maxCoeff() < kSameGoal;
}

void PathSearch::Begin(const VectorXd& start, const VectorXd& goal, bool goal_clear,
                       SearchLevels levels, std::uint64_t seed) {
  *this = {};
  state_ = State::kSearching;
  goal_ = goal;
  goal_clear_ = goal_clear;
  levels_ = std::move(levels);
  seed_ = seed;
  from_start_ = SearchTree(start);
  if (goal_clear) from_goal_ = SearchTree(goal);
  nearest_distance_ = (goal - start).norm();
}

void PathSearch::MoveStart(robot::Clearance& clearance, const VectorXd& start, long& evaluations) {
  if ((from_start_.q(0) - start).cwiseAbs().maxCoeff() < kSameGoal) return;
  CertifiedMotion motion(clearance, margin());
  std::vector<std::pair<double, int>> near;
  for (int i = 0; i < from_start_.size(); ++i) {
    near.emplace_back((from_start_.q(i) - start).squaredNorm(), i);
  }
  const auto tries = std::min(near.size(), std::size_t{kMoveTries});
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(tries), near.end());
  for (std::size_t i = 0; i < tries; ++i) {
    if (motion.ClearShare(from_start_.q(near[i].second), start) < 1.0) continue;
    from_start_.AddRoot(start, near[i].second);
    evaluations += motion.evaluations();
    if (nearest_ == 0) nearest_ = from_start_.last();
    Note(0, levels_.least_gain);
    return;
  }
  evaluations += motion.evaluations();
  from_start_ = SearchTree(start);
  nearest_ = 0;
  nearest_distance_ = (goal_ - start).norm();
  if (state_ == State::kFound || state_ == State::kExhausted) state_ = State::kSearching;
  since_ = 0;
  level_nodes_ = from_goal_.size();
}

void PathSearch::Note(int node, double least_gain) {
  const double distance = (from_start_.q(node) - goal_).norm();
  if (!(distance < nearest_distance_)) return;
  if (distance < (1.0 - least_gain) * nearest_distance_) since_ = 0;
  nearest_ = node;
  nearest_distance_ = distance;
  ++improvements_;
}

void PathSearch::Found(int start_node, int goal_node) {
  path_ = JoinPaths(from_start_, start_node, from_goal_, goal_node);
  state_ = State::kFound;
}

bool PathSearch::TryStraight(Tools& tools) {
  if (!goal_clear_ || from_start_.size() > 1 || from_goal_.size() > 1) return false;
  if (!tools.motion.Clear(from_start_.q(0), goal_)) return false;
  path_ = {from_start_.q(0), goal_};
  state_ = State::kFound;
  return true;
}

void PathSearch::Continue(robot::Clearance& clearance, long most, long& evaluations) {
  if (state_ != State::kSearching) return;
  long spent = 0;
  while (spent < most && state_ == State::kSearching) {
    Tools tools(clearance, margin(), models::Random::Seed(seed_, draws_));
    RoomOf(clearance.model(), from_start_.q(0), goal_, tools.lower, tools.upper);
    const bool last = level_ + 1 == static_cast<int>(levels_.margins.size());
    const int nodes = from_start_.size() + from_goal_.size() - level_nodes_;
    if (draws_ == 0 && last) Descend(tools, 0);
    if (TryStraight(tools)) {
    } else if (!goal_clear_ || (last && draws_ % kApproachTurn == kApproachTurn - 1)) {
      Approach(tools);
    } else {
      Connect(tools);
    }
    ++draws_;
    spent += std::max(tools.motion.evaluations(), 1L);
    since_ += std::max(tools.motion.evaluations(), 1L);
    if (state_ != State::kSearching) break;
    const int most_nodes = last ? levels_.last_nodes : levels_.nodes;
    // A draw that leads nowhere costs time as well.
    const bool full = goal_clear_ ? std::max(nodes, static_cast<int>(draws_)) >= most_nodes
                                  : since_ > levels_.patience;
    if (!full) continue;
    if (last) {
      state_ = State::kExhausted;
    } else {
      ++level_;
      level_nodes_ = from_start_.size() + from_goal_.size();
      draws_ = 0;
      seed_ = models::Random::Seed(seed_, "level");
    }
  }
  evaluations += spent;
}

void PathSearch::Connect(Tools& tools) {
  SearchTree& growing = start_grows_ ? from_start_ : from_goal_;
  SearchTree& other = start_grows_ ? from_goal_ : from_start_;
  VectorXd q(goal_.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = tools.random.Uniform(tools.lower[i], tools.upper[i]);
  }
  const int most = 2 * levels_.last_nodes;
  const int before = from_start_.size();
  const bool grew = growing.Grow(q, kEdge, most, tools.motion).grew;
  if (grew) {
    const VectorXd meeting = growing.q(growing.last());
    if (other.Grow(meeting, kEdge, most, tools.motion).arrived) {
      const int at = other.Nearest(meeting);
      if (start_grows_) {
        Found(growing.last(), at);
      } else {
        Found(at, growing.last());
      }
    }
  }
  for (int i = before; i < from_start_.size(); ++i) Note(i, levels_.least_gain);
  // The smaller tree grows, unless it is shut in.
  start_grows_ = grew ? from_start_.size() <= from_goal_.size() : !start_grows_;
}

void PathSearch::Approach(Tools& tools) {
  // Uniform in the ball about the goal that is nearer than the nearest, or near the latter.
  const bool local = draws_ % 2 == 0;
  const VectorXd centre = local ? VectorXd(from_start_.q(nearest_)) : goal_;
  const double radius = local ? 0.5 * nearest_distance_ : nearest_distance_;
  VectorXd out(goal_.size());
  for (int i = 0; i < kBallTries; ++i) {
    for (Eigen::Index j = 0; j < out.size(); ++j) out[j] = tools.random.Uniform(-1.0, 1.0);
    if (out.squaredNorm() <= 1.0) break;
  }
  if (out.norm() > 1.0) out /= out.norm();
  const VectorXd q = (centre + radius * out).cwiseMax(tools.lower).cwiseMin(tools.upper);
  const int before = from_start_.size();
  const int improved = improvements_;
  from_start_.Grow(q, kEdge, before + 20, tools.motion);
  for (int i = before; i < from_start_.size(); ++i) Note(i, levels_.least_gain);
  // From a new place that may lead to another valley.
  if (from_start_.size() > before && (improvements_ > improved || draws_ % 4 == 0)) {
    Descend(tools, from_start_.last());
  }
}

void PathSearch::Descend(Tools& tools, int from) {
  const auto n = goal_.size();
  const robot::RobotModel& model = tools.clearance.model();
  qp::ProjectionQp qp(static_cast<int>(n), kMostRows);
  qp::ProjectionSolver solver(static_cast<int>(n), kMostRows);
  qp::QpSolution solution(qp);
  qp.weights.setOnes(n);
  VectorXd row(n);
  for (int step = 0; step < kDescents; ++step) {
    const VectorXd q = from_start_.q(from);
    tools.clearance.MoveTo(q);
    tools.clearance.Collect(tools.margin + kDescentReach, tools.pairs);
    std::sort(tools.pairs.begin(), tools.pairs.end(),
              [](const auto& a, const auto& b) { return a.distance < b.distance; });
    qp.wish = goal_ - q;
    qp.lower = (model.lower_limits() - q).cwiseMax(-kDescentStep).cwiseMin(0.0);
    qp.upper = (model.upper_limits() - q).cwiseMin(kDescentStep).cwiseMax(0.0);
    qp.num_rows = 0;
    for (const robot::NearPair& pair : tools.pairs) {
      if (qp.num_rows == kMostRows) break;
      tools.clearance.Gradient(pair, row);
      qp.rows.row(qp.num_rows) = row.transpose();
      qp.bounds[qp.num_rows] =
          std::min(tools.margin + pair.scale * kDescentRoom - pair.distance, 0.0);
      qp.penalties[qp.num_rows] = kRowPenalty;
      ++qp.num_rows;
    }
    solution.active.clear();
    solver.Solve(qp, solution);
    if (!solution.u.allFinite()) return;
    // Curvature may spend what the linear model left: then less of the step.
    const VectorXd next = q + solution.u;
    const double share = tools.motion.ClearShare(q, next);
    const VectorXd reached = share == 1.0 ? next : VectorXd(q + 0.9 * share * solution.u);
    const double gain = (q - goal_).norm() - (reached - goal_).norm();
    if (!(gain > 1e-4)) return;
    from_start_.Add(reached, from);
    from = from_start_.last();
    Note(from, levels_.least_gain);
  }
}

}  // namespace oca::planning
