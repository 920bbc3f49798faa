// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/rrt_connect.h"

#include <limits>
#include <utility>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/planning/path_shortening.h"
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

void Shorten(robot::Clearance& clearance, const RrtOptions& options, Path& path) {
  PathShortening shortening(std::move(path), options.margin, options.seed, options.shortcuts);
  long evaluations = 0;
  shortening.Continue(clearance, std::numeric_limits<long>::max(), evaluations);
  path = shortening.path();
}

}  // namespace oca::planning
