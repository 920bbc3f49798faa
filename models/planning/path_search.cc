// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oca/models/qp/projection_solver.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

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

}  // namespace

struct PathSearch::Tools {
  Tools(robot::Clearance& all, double keep, const VectorXd& start, const VectorXd& goal)
      : clearance(all), margin(keep), motion(all, keep), room(all.model(), start, goal) {}
  robot::Clearance& clearance;
  const double margin;
  CertifiedMotion motion;
  SearchRoom room;
  models::Random random{0};
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
  trees_ = TreePair(start, goal_clear ? &goal : nullptr);
  nearest_distance_ = (goal - start).norm();
}

void PathSearch::MoveStart(robot::Clearance& clearance, const VectorXd& start, long& evaluations) {
  if ((trees_.from_start.q(0) - start).cwiseAbs().maxCoeff() < kSameGoal) return;
  CertifiedMotion motion(clearance, margin());
  std::vector<std::pair<double, int>> near;
  for (int i = 0; i < trees_.from_start.size(); ++i) {
    near.emplace_back((trees_.from_start.q(i) - start).squaredNorm(), i);
  }
  const auto tries = std::min(near.size(), std::size_t{kMoveTries});
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(tries), near.end());
  for (std::size_t i = 0; i < tries; ++i) {
    if (motion.ClearShare(trees_.from_start.q(near[i].second), start) < 1.0) continue;
    trees_.from_start.AddRoot(start, near[i].second);
    evaluations += motion.evaluations();
    if (nearest_ == 0) nearest_ = trees_.from_start.last();
    Note(0, levels_.least_gain);
    if (shortens_ && !shortening_.MoveStart(clearance, start, evaluations)) SearchOn();
    return;
  }
  evaluations += motion.evaluations();
  trees_.from_start = SearchTree(start);
  nearest_ = 0;
  nearest_distance_ = (goal_ - start).norm();
  SearchOn();
  since_ = 0;
  level_nodes_ = trees_.from_goal.size();
}

void PathSearch::AimAtNearest() {
  goal_ = trees_.from_start.q(nearest_);
  goal_clear_ = true;
  trees_.from_goal = SearchTree(goal_);
  nearest_distance_ = 0.0;
  Find(PathToNearest());
}

void PathSearch::Find(std::vector<VectorXd> path) {
  if (path.size() == 1) path.push_back(path.front());  // it is where it starts
  shortening_ = PathShortening(std::move(path), margin(), seed_, levels_.shortcuts);
  shortens_ = true;
  tries_ = 0;
  state_ = shortening_.done() ? State::kFound : State::kSearching;
}

void PathSearch::SearchOn() {
  shortens_ = false;
  state_ = State::kSearching;
}

void PathSearch::Note(int node, double least_gain) {
  const double distance = (trees_.from_start.q(node) - goal_).norm();
  if (!(distance < nearest_distance_)) return;
  if (distance < (1.0 - least_gain) * nearest_distance_) since_ = 0;
  nearest_ = node;
  nearest_distance_ = distance;
  ++improvements_;
}

bool PathSearch::TryStraight(Tools& tools) {
  if (!goal_clear_ || trees_.from_start.size() > 1 || trees_.from_goal.size() > 1) return false;
  if (!tools.motion.Clear(trees_.from_start.q(0), goal_)) return false;
  Find({trees_.from_start.q(0), goal_});
  return true;
}

void PathSearch::Continue(robot::Clearance& clearance, long most, long& evaluations) {
  const long until = evaluations + most;
  while (state_ == State::kSearching && evaluations < until) {
    if (shortens_) {
      shortening_.Continue(clearance, until - evaluations, evaluations);
      if (shortening_.done()) state_ = State::kFound;
      continue;
    }
    Tools tools(clearance, margin(), trees_.from_start.q(0), goal_);
    const VectorXd start = trees_.from_start.q(0);
    // Passages may leave no more than the last margin: half of the nodes are for these.
    const bool narrow = AtLastLevel() && NodesOfLevel() > levels_.last_nodes / 2;
    trees_.LeaveRoom(tools.motion, start, goal_clear_ ? goal_ : start, narrow ? 0.0 : kSampleRoom);
    while (state_ == State::kSearching && !shortens_ && tools.margin == margin() &&
           evaluations < until) {
      const long before = tools.motion.evaluations();
      Draw(tools);
      const long spent = std::max(tools.motion.evaluations() - before, 1L);
      evaluations += spent;
      since_ += spent;
    }
  }
}

void PathSearch::Draw(Tools& tools) {
  tools.random = models::Random(models::Random::Seed(seed_, draws_));
  const bool last = AtLastLevel();
  if (draws_ == 0 && last) Descend(tools, 0);
  if (TryStraight(tools)) {
  } else if (!goal_clear_ || (last && draws_ % kApproachTurn == kApproachTurn - 1)) {
    Approach(tools);
  } else {
    Connect(tools);
  }
  ++draws_;
  if (state_ != State::kSearching || shortens_) return;
  const int most_nodes = last ? levels_.last_nodes : levels_.nodes;
  // A draw that leads nowhere costs time as well.
  const bool full = goal_clear_ ? NodesOfLevel() >= most_nodes : since_ > levels_.patience;
  if (!full) return;
  if (last) {
    ProveNearest(tools);
    state_ = State::kExhausted;
  } else {
    ++level_;
    level_nodes_ = trees_.size();
    draws_ = 0;
    seed_ = models::Random::Seed(seed_, "level");
  }
}

bool PathSearch::AtLastLevel() const {
  return level_ + 1 == static_cast<int>(levels_.margins.size());
}

int PathSearch::NodesOfLevel() const {
  return std::max(trees_.size() - level_nodes_, static_cast<int>(draws_));
}

void PathSearch::ProveNearest(Tools& tools) {
  while (!trees_.from_start.Prove(nearest_, tools.motion)) FindNearest();
}

void PathSearch::FindNearest() {
  nearest_ = trees_.from_start.Nearest(goal_);
  nearest_distance_ = (trees_.from_start.q(nearest_) - goal_).norm();
}

void PathSearch::Connect(Tools& tools) {
  const int before = trees_.from_start.size();
  const int most = 4 * levels_.last_nodes;
  const bool met = trees_.Grow(tools.room.Draw(tools.random), kLongestEdge, most, tools.motion);
  for (int i = before; i < trees_.from_start.size(); ++i) Note(i, levels_.least_gain);
  if (!met) return;
  if (auto path = trees_.Prove(tools.motion)) {
    Find(*std::move(path));
  } else {
    FindNearest();
  }
}

void PathSearch::Approach(Tools& tools) {
  // Uniform in the ball about the goal that is nearer than the nearest, or near the latter.
  const bool local = draws_ % 2 == 0;
  const VectorXd centre = local ? VectorXd(trees_.from_start.q(nearest_)) : goal_;
  const double radius = local ? 0.5 * nearest_distance_ : nearest_distance_;
  VectorXd out(goal_.size());
  for (int i = 0; i < kBallTries; ++i) {
    for (Eigen::Index j = 0; j < out.size(); ++j) out[j] = tools.random.Uniform(-1.0, 1.0);
    if (out.squaredNorm() <= 1.0) break;
  }
  if (out.norm() > 1.0) out /= out.norm();
  const VectorXd q = (centre + radius * out).cwiseMax(tools.room.lower).cwiseMin(tools.room.upper);
  const int before = trees_.from_start.size();
  const int improved = improvements_;
  trees_.from_start.GrowUntilBlocked(
      q, {kLongestEdge, trees_.spacing(), trees_.room(), before + 20}, tools.motion);
  for (int i = before; i < trees_.from_start.size(); ++i) Note(i, levels_.least_gain);
  // From a new place that may lead to another valley.
  if (trees_.from_start.size() > before && (improvements_ > improved || draws_ % 4 == 0)) {
    Descend(tools, trees_.from_start.last());
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
    const VectorXd q = trees_.from_start.q(from);
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
    trees_.from_start.Add(reached, from);
    from = trees_.from_start.last();
    Note(from, levels_.least_gain);
  }
}

}  // namespace oca::planning
