// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/jacobian_mapping.h"

#include <cassert>

#include "oca/models/robot/joint_axis.h"

namespace oca::robot {
namespace {

// A pivot below this share of its diagonal entry is rounding: the share is sin^2 of the angle
// between a column of J and the span of those before it.
constexpr double kLeastPivot = 1e-12;

bool Factorise(MappingWorkspace& workspace) {
  workspace.factor.compute(workspace.normal);
  if (workspace.factor.info() != Eigen::Success) return false;
  const auto& L = workspace.factor.matrixLLT();
  for (int i = 0; i < L.rows(); ++i) {
    if (!(L(i, i) * L(i, i) >= kLeastPivot * workspace.normal(i, i))) return false;
  }
  return true;
}

// Composite at and beyond each link, about the link's origin, tips first.
void SumComposites(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                   std::vector<MappingWorkspace::Composite>& composites) {
  for (auto& composite : composites) {
    composite = {0.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  }
  for (int link = model.num_links() - 1; link > 0; --link) {
    const KinematicStep& step = model.steps()[link - 1];
    auto& own = composites[link];
    if (step.column >= 0) {
      own.count += 1.0;
      own.second.diagonal().array() += 1.0;  // the body's rotary inertia; its arm is zero
    }
    const Eigen::Vector3d d = X_WL[link].translation() - X_WL[step.parent_link].translation();
    auto& parent = composites[step.parent_link];
    parent.count += own.count;
    parent.first += own.first + own.count * d;
    // Sum over bodies of |r + d|^2 I - (r + d)(r + d)^T.
    const double trace = 2.0 * own.first.dot(d) + own.count * d.squaredNorm();
    parent.second += own.second;
    parent.second.noalias() -= (own.first + own.count * d) * d.transpose();
    parent.second.noalias() -= d * own.first.transpose();
    parent.second.diagonal().array() += trace;
  }
}

double Along(const KinematicStep& step, const Eigen::Vector3d& axis_W, const Eigen::Vector3d& force,
             const Eigen::Vector3d& moment) {
  return step.multiplier * axis_W.dot(step.type == JointType::kPrismatic ? force : moment);
}

}  // namespace

MappingWorkspace::MappingWorkspace(const RobotModel& model)
    : link_wrenches(model.links().size()),
      composites(model.links().size()),
      normal(Eigen::MatrixXd::Identity(model.num_positions(), model.num_positions())),
      factor(normal) {}

void MultiplyTransposed(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                        std::span<const BodyWrench> wrenches, MappingWorkspace& workspace,
                        Eigen::Ref<Eigen::VectorXd> Jt_w) {
  assert(std::ssize(X_WL) == model.num_links());
  assert(std::ssize(wrenches) == model.num_bodies());
  assert(Jt_w.size() == model.num_positions());
  auto& sums = workspace.link_wrenches;
  for (BodyWrench& sum : sums) sum = BodyWrench{};
  for (int b = 0; b < model.num_bodies(); ++b) sums[model.bodies()[b]] = wrenches[b];
  Jt_w.setZero();
  for (int link = model.num_links() - 1; link > 0; --link) {
    const KinematicStep& step = model.steps()[link - 1];
    const BodyWrench& sum = sums[link];
    if (step.column >= 0) {
      const Eigen::Vector3d axis_W = internal::JointAxis(step, X_WL[link]);
      Jt_w[step.column] += Along(step, axis_W, sum.force, sum.torque);
    }
    const Eigen::Vector3d d = X_WL[link].translation() - X_WL[step.parent_link].translation();
    sums[step.parent_link].force += sum.force;
    sums[step.parent_link].torque += sum.torque + d.cross(sum.force);
  }
}

void ComputeNormalMatrix(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                         MappingWorkspace& workspace) {
  assert(std::ssize(X_WL) == model.num_links());
  SumComposites(model, X_WL, workspace.composites);
  Eigen::MatrixXd& normal = workspace.normal;
  normal.setZero();
  for (int link = 1; link < model.num_links(); ++link) {
    const KinematicStep& step = model.steps()[link - 1];
    if (step.column < 0) continue;
    // Momentum of the composite when this joint moves at unit rate, about this link's origin.
    const auto& composite = workspace.composites[link];
    const Eigen::Vector3d axis_W = step.multiplier * internal::JointAxis(step, X_WL[link]);
    const bool slides = step.type == JointType::kPrismatic;
    const Eigen::Vector3d linear = slides ? Eigen::Vector3d(composite.count * axis_W)
                                          : Eigen::Vector3d(axis_W.cross(composite.first));
    Eigen::Vector3d angular = slides ? Eigen::Vector3d(composite.first.cross(axis_W))
                                     : Eigen::Vector3d(composite.second * axis_W);
    normal(step.column, step.column) += axis_W.dot(slides ? linear : angular);
    for (int below = link, at = step.parent_link; at > 0;
         below = at, at = model.steps()[at - 1].parent_link) {
      angular += (X_WL[below].translation() - X_WL[at].translation()).cross(linear);
      const KinematicStep& other = model.steps()[at - 1];
      if (other.column < 0) continue;
      const Eigen::Vector3d other_axis_W = internal::JointAxis(other, X_WL[at]);
      const double entry = Along(other, other_axis_W, linear, angular);
      // A mimic joint and its master on one path share a column, which then gets both terms.
      normal(step.column, other.column) += entry;
      normal(other.column, step.column) += entry;
    }
  }
}

MappingStatus MapWrenches(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                          std::span<const BodyWrench> wrenches, const MappingSettings& settings,
                          MappingWorkspace& workspace, Eigen::Ref<Eigen::VectorXd> delta) {
  assert(settings.damping >= 0.0);
  MultiplyTransposed(model, X_WL, wrenches, workspace, delta);
  MappingStatus status = MappingStatus::kOk;
  if (settings.method != MappingMethod::kTranspose && delta.size() > 0) {
    ComputeNormalMatrix(model, X_WL, workspace);
    if (settings.method == MappingMethod::kDamped) {
      workspace.normal.diagonal().array() += settings.damping * settings.damping;
    }
    if (!Factorise(workspace)) {
      status = MappingStatus::kRegularised;
      workspace.normal.diagonal() *= 1.0 + kRegularisation;  // each joint's by its own size
      workspace.factor.compute(workspace.normal);
    }
    workspace.factor.solveInPlace(delta);
  }
  delta *= settings.alpha;
  if (!delta.allFinite()) {
    delta.setZero();
    return MappingStatus::kNotFinite;
  }
  return status;
}

}  // namespace oca::robot
