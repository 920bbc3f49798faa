// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/rrt_connect.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/random.h"
#include "oca/models/robot/joint_limits.h"

namespace oca::planning {
namespace {

using Path = std::vector<Eigen::VectorXd>;

// A piece of an edge shorter than this is not worth a node, rad.
constexpr double kLeastProgress = 0.02;

struct Node {
  Eigen::VectorXd q;
  int parent;
};

class Tree {
 public:
  explicit Tree(const Eigen::VectorXd& root) { nodes_.push_back({root, -1}); }

  int size() const { return static_cast<int>(nodes_.size()); }
  const Eigen::VectorXd& q(int node) const { return nodes_[node].q; }
  int last() const { return size() - 1; }

  int Nearest(const Eigen::VectorXd& q) const {
    int nearest = 0;
    double least = (nodes_[0].q - q).squaredNorm();
    for (int i = 1; i < size(); ++i) {
      const double distance = (nodes_[i].q - q).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      nearest = i;
    }
    return nearest;
  }

  /// Grows from the nearest node towards q as far as it is clear, and as `most` nodes go however
  /// far q is; whether it arrived, and grew.
  struct Growth {
    bool arrived;
    bool grew;
  };
  Growth Grow(const Eigen::VectorXd& q, double step, int most, CertifiedMotion& motion) {
    int from = Nearest(q);
    bool grew = false;
    while (size() < most) {
      const Eigen::VectorXd way = q - nodes_[from].q;
      const double length = way.norm();
      if (length == 0.0) return {true, grew};
      const double share = std::min(1.0, step / length);
      const Eigen::VectorXd next = share == 1.0 ? q : Eigen::VectorXd(nodes_[from].q + share * way);
      const double clear = motion.ClearShare(nodes_[from].q, next);
      const bool whole = clear == 1.0 && (share < 1.0 || motion.Clear(next));
      if (!whole && 0.9 * clear * share * length < kLeastProgress) return {false, grew};
      nodes_.push_back(
          {whole ? next : Eigen::VectorXd(nodes_[from].q + 0.9 * clear * share * way), from});
      from = last();
      grew = true;
      if (!whole || share == 1.0) return {whole, grew};
    }
    return {false, grew};
  }

  /// From the root to a node.
  Path PathTo(int node) const {
    Path path;
    for (; node >= 0; node = nodes_[node].parent) path.push_back(nodes_[node].q);
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  std::vector<Node> nodes_;
};

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

Path Join(const Tree& from_start, int start_node, const Tree& from_goal, int goal_node) {
  Path path = from_start.PathTo(start_node);
  Path back = from_goal.PathTo(goal_node);
  path.insert(path.end(), std::next(back.rbegin()), back.rend());  // the meeting point once
  return path;
}

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
        Path path = start_grows ? Join(from_start, growing.last(), from_goal, other_node)
                                : Join(from_start, other_node, from_goal, growing.last());
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
