// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/rrt_connect.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/planning/search_tree.h"
#include "oca/models/random.h"
#include "oca/models/robot/joint_limits.h"

namespace oca::planning {
namespace {

using Path = std::vector<Eigen::VectorXd>;

using Tree = SearchTree;

struct Room {
  Eigen::VectorXd lower, upper;

  Room(const robot::RobotModel& model, const Eigen::VectorXd& start, const Eigen::VectorXd& goal)
      : lower(model.lower_limits()), upper(model.upper_limits()) {
    for (Eigen::Index i = 0; i < lower.size(); ++i) {
      if (robot::HasOwnRange(model, i)) continue;
      lower[i] = std::max(lower[i], std::min(start[i], goal[i]) - std::numbers::pi);
      upper[i] = std::min(upper[i], std::max(start[i], goal[i]) + std::numbers::pi);
    }
  }
  Eigen::VectorXd Draw(models::Random& random) const {
    Eigen::VectorXd q(lower.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = random.Uniform(lower[i], upper[i]);
    return q;
  }
};

}  // namespace

std::optional<Path> RrtConnect(robot::Clearance& clearance, const Eigen::VectorXd& start,
                               const Eigen::VectorXd& goal, const RrtOptions& options) {
  CertifiedMotion motion(clearance, options.margin);
  if (!motion.Clear(start) || !motion.Clear(goal)) return std::nullopt;
  if (motion.Clear(start, goal)) return Path{start, goal};
  Tree from_start(start);
  Tree from_goal(goal);
  const Room room(clearance.model(), start, goal);
  models::Random random(options.seed);
  bool start_grows = true;
  // A draw that leads nowhere costs time as well.
  for (int draws = 0; draws < options.most_nodes; ++draws) {
    if (from_start.size() + from_goal.size() >= options.most_nodes) break;
    Tree& growing = start_grows ? from_start : from_goal;
    Tree& other = start_grows ? from_goal : from_start;
    const auto grow = [&](Tree& tree, const Eigen::VectorXd& towards) {
      const int most = options.most_nodes - (&tree == &growing ? other : growing).size();
      return tree.Grow(towards, options.step, most, motion);
    };
    if (grow(growing, room.Draw(random)).grew) {
      const Eigen::VectorXd meeting = growing.q(growing.last());
      if (grow(other, meeting).arrived) {
        const int other_node = other.Nearest(meeting);
        Path path = start_grows ? JoinPaths(from_start, growing.last(), from_goal, other_node)
                                : JoinPaths(from_start, other_node, from_goal, growing.last());
        Shorten(clearance, options, path);
        return path;
      }
    }
    start_grows = from_start.size() <= from_goal.size();
  }
  return std::nullopt;
}

void Shorten(robot::Clearance& clearance, const RrtOptions& options, Path& path) {
  CertifiedMotion motion(clearance, options.margin);
  models::Random random(models::Random::Seed(options.seed, "shorten"));
  for (int i = 0; i < options.shortcuts && path.size() > 2; ++i) {
    // Two points on different edges, anywhere on them.
    std::size_t a = random.Below(path.size() - 1);
    std::size_t b = random.Below(path.size() - 1);
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    const Eigen::VectorXd from = path[a] + random.Unit() * (path[a + 1] - path[a]);
    const Eigen::VectorXd to = path[b] + random.Unit() * (path[b + 1] - path[b]);
    if (!motion.Clear(from, to)) continue;
    Path shorter(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(a) + 1);
    shorter.push_back(from);
    shorter.push_back(to);
    shorter.insert(shorter.end(), path.begin() + static_cast<std::ptrdiff_t>(b) + 1, path.end());
    path = std::move(shorter);
  }
}

}  // namespace oca::planning
