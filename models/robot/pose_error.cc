// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/pose_error.h"

#include <cmath>

namespace oca::robot {

Vector6 PoseError(const Eigen::Isometry3d& X_WL, const Eigen::Isometry3d& X_WG) {
  // Eigen's angle is in [0, pi] and exact near both ends, as it goes by way of the quaternion.
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_WL.linear() * X_WG.linear().transpose()));
  Vector6 error;
  error << X_WL.translation() - X_WG.translation(), turn.angle() * turn.axis();
  return error;
}

void PoseErrorJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                       const Eigen::Isometry3d& X_WG, Eigen::Ref<Matrix6X> J) {
  LinkJacobian(model, X_WL, link, J);
  const Eigen::Vector3d e = PoseError(X_WL[link], X_WG).tail<3>();
  const double t = e.norm();
  // Below, the series 1 / 12 + t^2 / 720 has lost nothing and the quotient all.
  const double factor = t < 1e-3 ? 1.0 / 12.0 : (1.0 - 0.5 * t / std::tan(0.5 * t)) / (t * t);
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const Eigen::Vector3d w = J.col(j).tail<3>();
    const Eigen::Vector3d turned = e.cross(w);
    J.col(j).tail<3>() = w - 0.5 * turned + factor * e.cross(turned);
  }
}

}  // namespace oca::robot
