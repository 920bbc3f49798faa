// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/rrt_connect.h"

#include <utility>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Path = std::vector<Eigen::VectorXd>;

}  // namespace

std::optional<Path> RrtConnect(robot::Clearance& clearance, const Eigen::VectorXd& start,
                               const Eigen::VectorXd& goal, const RrtOptions& options) {
  CertifiedMotion motion(clearance, options.margin);
  if (!motion.Clear(start) || !motion.Clear(goal)) return std::nullopt;
  if (motion.Clear(start, goal)) return Path{start, goal};
  TreePair trees(start, &goal);
  trees.LeaveRoom(motion, start, goal);
  const SearchRoom room(clearance.model(), start, goal);
  models::Random random(options.seed);
  // A draw that leads nowhere costs time as well.
  for (int draws = 0; draws < options.most_nodes; ++draws) {
    if (trees.size() >= options.most_nodes) break;
    if (!trees.Grow(room.Draw(random), options.step, options.most_nodes, motion)) continue;
    if (auto path = trees.Prove(motion)) {
      Shorten(clearance, options, *path);
      return path;
    }
  }
  return std::nullopt;
}

long Shorten(robot::Clearance& clearance, const RrtOptions& options, Path& path) {
  CertifiedMotion motion(clearance, options.margin);
  if (path.size() <= 2) return 0;
  // Whatever is nearer takes long to prove.
  const double room = motion.RoomOf(path.front(), path.back(), kSampleRoom);
  models::Random random(models::Random::Seed(options.seed, "shorten"));
  for (int i = 0; i < options.shortcuts && path.size() > 2; ++i) {
    // Two points on different edges, anywhere on them.
    std::size_t a = random.Below(path.size() - 1);
    std::size_t b = random.Below(path.size() - 1);
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    const Eigen::VectorXd from = path[a] + random.Unit() * (path[a + 1] - path[a]);
    const Eigen::VectorXd to = path[b] + random.Unit() * (path[b + 1] - path[b]);
    if (!motion.Clear(from, to, room)) continue;
    Path shorter(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(a) + 1);
    shorter.push_back(from);
    shorter.push_back(to);
    shorter.insert(shorter.end(), path.begin() + static_cast<std::ptrdiff_t>(b) + 1, path.end());
    path = std::move(shorter);
  }
  return motion.evaluations();
}

}  // namespace oca::planning
