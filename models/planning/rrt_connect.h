// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "oca/models/planning/tree_pair.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

struct RrtOptions {
  std::uint64_t seed{0};
  double margin{0.01};        ///< m; everything stays farther apart than this
  int most_nodes{5000};       ///< of both trees together
  double step{kLongestEdge};  ///< rad; longest edge
  int shortcuts{200};         ///< attempts to shorten what was found; 0: as it is
};

/// A path of straight joint motions from `start` to `goal` on which the robot stays clear of the
/// bodies of `clearance`, both ends included; nothing if a tree of `most_nodes` has found none.
///
/// Two trees grow from the ends: one by an edge towards a random position within the joint limits
/// (a joint without limits: within half a turn of both ends), the other as far as it can towards
/// the new node. Edges are looked at by samples, eight at once; the path through both trees is
/// proved clear by CertifiedMotion, so that the answer holds between the points too: an edge that
/// cannot be proved is cut off with what is behind it, and the search goes on with samples half as
/// far apart. The same arguments give the same path. Allocates.
/// source Kuffner, LaValle, RRT-Connect: An Efficient Approach to Single-Query Path Planning, 2000
std::optional<std::vector<Eigen::VectorXd>> RrtConnect(robot::Clearance& clearance,
                                                       const Eigen::VectorXd& start,
                                                       const Eigen::VectorXd& goal,
                                                       const RrtOptions& options = {});

/// PathShortening of all options.shortcuts.
void Shorten(robot::Clearance& clearance, const RrtOptions& options,
             std::vector<Eigen::VectorXd>& path);

}  // namespace oca::planning
