// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "oca/models/robot/kinematics.h"

namespace oca::robot {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// How far a frame L is from a goal G: (p_WL - p_WG, log(R_WL R_WG^T)), m and rad, world axes. The
/// length of the rotation part is its angle, at most pi.
Vector6 PoseError(const Eigen::Isometry3d& X_WL, const Eigen::Isometry3d& X_WG);

/// Derivative of the PoseError of `link` by the positions: J is 6 x n. With e the rotation part,
/// t its length and K its cross product matrix, the angular rows of LinkJacobian are multiplied by
///
///     I - K / 2 + (1 - (t / 2) / tan(t / 2)) / t^2 K^2
///
/// No heap. source Sola, Deray, Atchuthan, A micro Lie theory, 2018, eq. (146)
void PoseErrorJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                       const Eigen::Isometry3d& X_WG, Eigen::Ref<Matrix6X> J);

}  // namespace oca::robot
