// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/robot/filtered_inverse.h"

namespace oca::robot {

/// The joint velocity between `lower` and `upper` that leaves `wish` as little as it must to move
/// points with J u = xdot, given by M = J^T J and b = J^T xdot:
///
///     u = q_N + (J W)^+ (xdot - J q_N),   q_N = wish, W = I at first
///
/// While a joint leaves its bounds, the one that does so by most is held at its bound (in q_N, its
/// entry of W becomes 0) and the others take over what it cannot do. Lower and upper may be equal.
/// Not exactly as published: where the others cannot, the damping of the inverse lets the task go,
/// instead of a scale on all of xdot, and what is left over a bound is clipped.
/// source Flacco, De Luca, Khatib, Motion control of redundant robots under joint constraints:
///        saturation in the null space, ICRA 2012
JointVector SaturateInNullspace(const JointMatrix& M, const JointVector& b, const JointVector& wish,
                                const JointVector& lower, const JointVector& upper,
                                const Damping& damping);

}  // namespace oca::robot
