// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace oca::geometry::internal {

/// As many balls as a leaf of a BallTree holds.
inline constexpr int kBallsOfLeaf = 8;

/// Bit k is set if ball k comes within `reach` of `point`; `leaf` has x, y, z and radius of the
/// eight, eight numbers each. Uses AVX2 where the machine has it, with the same result.
unsigned NearBalls(const double* leaf, const Eigen::Vector3d& point, double reach);

/// The same without vector instructions; what the test compares with.
unsigned NearBallsPortable(const double* leaf, const Eigen::Vector3d& point, double reach);

}  // namespace oca::geometry::internal
