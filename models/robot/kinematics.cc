// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/robot/joint_axis.h"

namespace oca::robot {
namespace {

// R <- R * rotation about coordinate axis `axis` by `angle`: it turns two columns into each other.
template <typename Rotation>
void TurnColumns(Rotation&& R, int axis, double angle) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  const int u = axis == 2 ? 0 : axis + 1;
  const int v = axis == 0 ? 2 : axis - 1;
  const Eigen::Vector3d at_u = R.col(u);
  const Eigen::Vector3d at_v = R.col(v);
  R.col(u) = c * at_u + s * at_v;
  R.col(v) = c * at_v - s * at_u;
}

// R <- R * rotation about the unit vector `axis` by `angle`, by Rodrigues' formula.
template <typename Rotation>
void TurnAbout(Rotation&& R, const Eigen::Vector3d& axis, double angle) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  const Eigen::Matrix3d before = R;
  const Eigen::Vector3d along = (1.0 - c) * (before * axis);
  for (int i = 0; i < 3; ++i) {
    // Column i of R [axis]x is R (axis x e_i).
    const int j = i == 2 ? 0 : i + 1;
    const int k = i == 0 ? 2 : i - 1;
    R.col(i) = c * before.col(i) + s * (axis[k] * before.col(j) - axis[j] * before.col(k)) +
               axis[i] * along;
  }
}

// Adds the column of one joint to the Jacobian of a point at p_W; `J_w` may be null.
template <typename Linear, typename Angular>
void AddColumn(const KinematicStep& step, const Eigen::Isometry3d& X_WL, const Eigen::Vector3d& p_W,
               Linear&& J_v, Angular* J_w) {
  const Eigen::Vector3d axis_W = step.multiplier * internal::JointAxis(step, X_WL);
  if (step.type == JointType::kPrismatic) {
    J_v += axis_W;
    return;
  }
  J_v += axis_W.cross(p_W - X_WL.translation());
  if (J_w != nullptr) *J_w += axis_W;
}

template <typename Block>
void FillLinkJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                      Block&& J) {
  J.setZero();
  const Eigen::Vector3d p_W = X_WL[link].translation();
  for (int at = link; at > 0; at = model.steps()[at - 1].parent_link) {
    const KinematicStep& step = model.steps()[at - 1];
    if (step.column < 0) continue;
    auto angular = J.col(step.column).template tail<3>();
    AddColumn(step, X_WL[at], p_W, J.col(step.column).template head<3>(), &angular);
  }
}

}  // namespace

void CheckPositions(const RobotModel& model, const Eigen::Ref<const Eigen::VectorXd>& q) {
  if (q.size() != model.num_positions()) {
    throw models::ModelError(fmt::format("robot '{}': positions; got {}; expected {}",
                                         model.name().text(), q.size(), model.num_positions()));
  }
  for (int i = 0; i < q.size(); ++i) {
    if (!std::isfinite(q[i])) {
      throw models::ModelError(
          fmt::format("robot '{}': position of joint '{}'; got {}; expected a finite number",
                      model.name().text(), model.position_names()[i].text(), q[i]));
    }
  }
}

std::vector<Eigen::Isometry3d> LinkPoses(const RobotModel& model,
                                         const Eigen::Ref<const Eigen::VectorXd>& q) {
  CheckPositions(model, q);
  std::vector<Eigen::Isometry3d> X_WL(model.links().size());
  ForwardKinematics(model, q, X_WL);
  return X_WL;
}

void ForwardKinematics(const RobotModel& model, const Eigen::Ref<const Eigen::VectorXd>& q,
                       std::span<Eigen::Isometry3d> X_WL) {
  assert(q.size() == model.num_positions());
  assert(std::ssize(X_WL) == model.num_links());
  X_WL[0] = model.X_WB();
  std::size_t link = 1;
  for (const KinematicStep& step : model.steps()) {
    const Eigen::Isometry3d& X_WP = X_WL[step.parent_link];
    Eigen::Isometry3d& X = X_WL[link++];
    X.makeAffine();
    auto R = X.linear();
    if (step.rotated) {
      R.noalias() = X_WP.linear() * step.R_PJ;
    } else {
      R = X_WP.linear();
    }
    X.translation() = X_WP.translation();
    X.translation().noalias() += X_WP.linear() * step.p_PJ;
    if (step.column < 0) continue;
    const double position = step.multiplier * q[step.column] + step.offset;
    if (step.type == JointType::kPrismatic) {
      X.translation().noalias() += R * (position * step.axis);
    } else if (step.principal_axis < 3) {
      TurnColumns(R, step.principal_axis, step.sign * position);
    } else {
      TurnAbout(R, step.axis, position);
    }
  }
}

void PointJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                   const Eigen::Vector3d& p_W, Eigen::Ref<Eigen::Matrix3Xd> J_v) {
  assert(std::ssize(X_WL) == model.num_links());
  assert(J_v.cols() == model.num_positions());
  J_v.setZero();
  for (int at = link; at > 0; at = model.steps()[at - 1].parent_link) {
    const KinematicStep& step = model.steps()[at - 1];
    if (step.column < 0) continue;
    AddColumn(step, X_WL[at], p_W, J_v.col(step.column), static_cast<Eigen::Vector3d*>(nullptr));
  }
}

void LinkJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link,
                  Eigen::Ref<Matrix6X> J) {
  assert(std::ssize(X_WL) == model.num_links());
  assert(J.cols() == model.num_positions());
  FillLinkJacobian(model, X_WL, link, J);
}

void LinkVelocities(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                    const Eigen::Ref<const Eigen::VectorXd>& qdot,
                    std::span<LinkVelocity> velocities) {
  assert(std::ssize(X_WL) == model.num_links());
  assert(std::ssize(velocities) == model.num_links());
  assert(qdot.size() == model.num_positions());
  velocities[0] = {};
  for (int link = 1; link < model.num_links(); ++link) {
    const KinematicStep& step = model.steps()[link - 1];
    const LinkVelocity& parent = velocities[step.parent_link];
    LinkVelocity& V = velocities[link];
    V = parent;
    V.linear +=
        parent.angular.cross(X_WL[link].translation() - X_WL[step.parent_link].translation());
    if (step.column < 0) continue;
    const Eigen::Vector3d rate =
        step.multiplier * qdot[step.column] * (X_WL[link].linear() * step.axis);
    (step.type == JointType::kPrismatic ? V.linear : V.angular) += rate;
  }
}

void DistanceRow(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL, int link_a,
                 const Eigen::Vector3d& p_A, int link_b, const Eigen::Vector3d& p_B,
                 const Eigen::Vector3d& n, Eigen::Ref<Eigen::VectorXd> row) {
  assert(std::ssize(X_WL) == model.num_links());
  assert(row.size() == model.num_positions());
  row.setZero();
  // Parents have the smaller numbers, so the two paths to the root meet where they become one.
  int a = link_a;
  int b = std::max(link_b, 0);
  while (a != b) {
    const bool of_a = a > b;
    int& at = of_a ? a : b;
    const KinematicStep& step = model.steps()[at - 1];
    if (step.column >= 0) {
      Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
      AddColumn(step, X_WL[at], of_a ? p_A : p_B, velocity, static_cast<Eigen::Vector3d*>(nullptr));
      row[step.column] += (of_a ? 1.0 : -1.0) * n.dot(velocity);
    }
    at = step.parent_link;
  }
}

void StackedJacobian(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                     Eigen::Ref<Eigen::MatrixXd> J) {
  assert(std::ssize(X_WL) == model.num_links());
  assert(J.rows() == 6 * model.num_bodies() && J.cols() == model.num_positions());
  // A body turns as its parent body does, and moves as the parent would at its origin: the parent's
  // block, shifted there, and the own joint's column.
  for (int b = 0; b < model.num_bodies(); ++b) {
    const int link = model.bodies()[b];
    const KinematicStep& step = model.steps()[link - 1];
    const int parent = model.body_index(step.parent_link);
    if (parent < 0) {
      J.middleRows<6>(6 * b).setZero();
    } else {
      const Eigen::Vector3d p =
          X_WL[link].translation() - X_WL[model.bodies()[parent]].translation();
      for (Eigen::Index c = 0; c < J.cols(); ++c) {
        const double* const above = J.data() + c * J.outerStride() + 6 * parent;
        const double x = above[3], y = above[4], z = above[5];
        double* const here = J.data() + c * J.outerStride() + 6 * b;
        here[0] = above[0] + (y * p[2] - z * p[1]);
        here[1] = above[1] + (z * p[0] - x * p[2]);
        here[2] = above[2] + (x * p[1] - y * p[0]);
        here[3] = x;
        here[4] = y;
        here[5] = z;
      }
    }
    const int half = step.type == JointType::kPrismatic ? 0 : 3;
    J.block<3, 1>(6 * b + half, step.column) +=
        step.multiplier * internal::JointAxis(step, X_WL[link]);
  }
}

}  // namespace oca::robot
