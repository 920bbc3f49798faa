// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/loop_gain.h"

#include <cassert>
#include <cmath>

#include "oca/models/robot/kinematics.h"

namespace oca::robot {
namespace {

constexpr int kSquarings = 4;

// L <- C^-1 L C^-T with J^T J = C C^T: as M L, it has the spectrum of the loop, and is symmetric if
// L was. Transposed in between, which changes no eigenvalue.
void Divide(const MappingSettings& settings, LoopGainWorkspace& workspace) {
  MappingWorkspace& mapping = workspace.mapping;
  const double damping = settings.method == MappingMethod::kDamped ? settings.damping : 0.0;
  mapping.normal.diagonal().array() += damping * damping;
  mapping.factor.compute(mapping.normal);
  if (mapping.factor.info() != Eigen::Success) {
    mapping.normal.diagonal() *= 1.0 + kRegularisation;
    mapping.factor.compute(mapping.normal);
  }
  mapping.factor.matrixL().solveInPlace(workspace.loop);
  workspace.square = workspace.loop.transpose();
  mapping.factor.matrixL().solveInPlace(workspace.square);
  workspace.loop.swap(workspace.square);
}

// |A^(2^k)|^(1 / 2^k), scaled at each squaring so that nothing overflows.
double RadiusBound(Eigen::MatrixXd& A, Eigen::MatrixXd& square) {
  double log_scale = 0.0;
  double share = 1.0;
  for (int k = 0; k <= kSquarings; ++k, share *= 0.5) {
    const double norm = A.norm();
    if (norm == 0.0) return 0.0;
    log_scale += share * std::log(norm);
    if (k == kSquarings) break;
    A /= norm;
    square.noalias() = A.lazyProduct(A);
    A.swap(square);
  }
  return std::exp(log_scale);
}

}  // namespace

LoopGainWorkspace::LoopGainWorkspace(const RobotModel& model)
    : mapping(model),
      loop(Eigen::MatrixXd::Zero(model.num_positions(), model.num_positions())),
      square(loop),
      push(Eigen::VectorXd::Zero(model.num_positions())),
      row(push) {}

double LoopGainOf(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                  std::span<const GainContact> contacts, const MappingSettings& settings,
                  LoopGainWorkspace& workspace) {
  workspace.loop.setZero();
  for (const GainContact& contact : contacts) {
    DistanceRow(model, X_WL, contact.link, contact.point, contact.other, contact.other_point,
                contact.slope, workspace.push);
    DistanceRow(model, X_WL, contact.link, contact.point, contact.other, contact.other_point,
                contact.normal, workspace.row);
    workspace.loop.noalias() += workspace.push.lazyProduct(workspace.row.transpose());
  }
  if (workspace.loop.isZero(0.0)) return 0.0;
  if (settings.method != MappingMethod::kTranspose) {
    ComputeNormalMatrix(model, X_WL, workspace.mapping);
    Divide(settings, workspace);
  }
  return std::fabs(settings.alpha) * RadiusBound(workspace.loop, workspace.square);
}

double LeastRelaxationTime(double gain, double dt) { return 0.5 * dt * (1.0 + gain); }

}  // namespace oca::robot
