// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

// Conventions of this file. q holds num_positions() joint positions (rad, m). X_WL holds one pose a
// link, in the order of the model. All vectors have world axes. A Jacobian has num_positions()
// columns; a mimic joint adds to its master's column with its multiplier. Except for LinkPoses and
// CheckPositions no function allocates, and sizes are asserted, not checked.

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// throws ModelError if q has the wrong length or holds a number that is not finite
void CheckPositions(const RobotModel& model, const Eigen::Ref<const Eigen::VectorXd>& q);

/// Poses of all links in the world. throws ModelError as CheckPositions does
std::vector<Eigen::Isometry3d> LinkPoses(const RobotModel& model,
                                         const Eigen::Ref<const Eigen::VectorXd>& q);

/// The same in one pass into `X_WL` (num_links() poses).
void ForwardKinematics(const RobotModel& model, const Eigen::Ref<const Eigen::VectorXd>& q,
                       std::span<Eigen::Isometry3d> X_WL);

/// Motion of a link's frame, world axes: velocity of its origin (m/s), angular velocity (rad/s).
struct LinkVelocity {
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};
};

/// Velocities of all links (num_links()) from the rates of the positions (rad/s, m/s), in one pass.
void LinkVelocities(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                    const Eigen::Ref<const Eigen::VectorXd>& qdot,
                    std::span<LinkVelocity> velocities);

/// Velocity of the point of `link` that is now at p_W: v = J_v qdot. J_v is 3 x n.
void PointJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                   const Eigen::Vector3d& p_W, Eigen::Ref<Eigen::Matrix3Xd> J_v);

/// Velocity of the origin of `link`: rows 0-2 linear, 3-5 angular. J is 6 x n.
void LinkJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                  Eigen::Ref<Matrix6X> J);

/// How the distance rho of two links of the robot changes: d(rho)/dt = row qdot with
///
///     row = n^T (J_A(p_A) - J_B(p_B)),   p_A - p_B = rho n
///
/// n is the unit normal from B to A, p_A and p_B the nearest points. The joints that carry both
/// links keep rho, so their entries are 0. With link_b = -1 B is something at rest; row has
/// num_positions() entries. source docs/theory.md, Distance rate
void DistanceRow(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link_a,
                 const Eigen::Vector3d& p_A, int link_b, const Eigen::Vector3d& p_B,
                 const Eigen::Vector3d& n, Eigen::Ref<Eigen::VectorXd> row);

/// The Jacobian of each body (LinkJacobian), all below each other, in the order of
/// RobotModel::bodies(): J is 6 num_bodies() x n; 42 x 7 for an arm of seven joints.
/// source report eq. (3.4)
void StackedJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                     Eigen::Ref<Eigen::MatrixXd> J);

}  // namespace oca::robot
