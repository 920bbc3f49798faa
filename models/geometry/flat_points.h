// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace oca::geometry::internal {

inline constexpr double kThinnest = 1e-4;  ///< what flat points are padded to, of their extent

/// Gives points that lie in one plane or line but for `flattest` of their extent (the longest edge
/// of their box) a thickness of kThinnest of it: each becomes two, on either side. Returns that
/// thickness, m; 0 if the points were thicker and stay as they are.
double PadFlat(std::vector<Eigen::Vector3d>& points, double flattest);

}  // namespace oca::geometry::internal
