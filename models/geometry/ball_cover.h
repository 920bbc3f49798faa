// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/models/geometry/ball_tree.h"
#include "oca/models/geometry/collider.h"

namespace oca::geometry {

/// Balls that together contain all of a solid, in its frame, for tests that may err on one side
/// only: what keeps clear of the balls keeps clear of the solid.
///
/// A capsule is covered along its axis. Any other convex solid is put into a polyhedron that
/// contains it, which is cut across its longest principal axis, the piece that sticks out farthest
/// first, until no ball sticks out of its piece by more than `slack` (m; ball's radius less the
/// least half extent of the piece) or there are `most` balls. Of a compound each part has `most`.
/// A half-space has none.
std::vector<Ball> CoverWithBalls(const Collider& solid, int most, double slack);

/// Radius of a ball about `point` (the solid's frame) that the solid contains, m, as large as there
/// is; 0 where there is none, and of compounds.
double InnerRadius(const Collider& solid, const Eigen::Vector3d& point);

/// A ball that contains all of `points`, nearly the smallest.
/// source Badoiu, Clarkson, Smaller core-sets for balls, 2003
Ball EnclosingBall(const std::vector<Eigen::Vector3d>& points);

}  // namespace oca::geometry
