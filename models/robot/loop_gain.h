// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "oca/models/robot/jacobian_mapping.h"

namespace oca::robot {

/// A contact whose force on `link` at `point` changes by -slope d(rho), rho its distance along the
/// unit normal `normal` (from the obstacle to the link). If the obstacle is `other`, a link of the
/// same robot (-1: none), the force acts on that one too, reversed, at `other_point`.
struct GainContact {
  int link;
  Eigen::Vector3d point;
  int other;
  Eigen::Vector3d other_point;
  Eigen::Vector3d normal;
  Eigen::Vector3d slope;  // N/m, along the force
};

struct LoopGainWorkspace {
  explicit LoopGainWorkspace(const RobotModel& model);

  MappingWorkspace mapping;
  Eigen::MatrixXd loop;    // n x n
  Eigen::MatrixXd square;  // n x n
  Eigen::VectorXd push;    // n
  Eigen::VectorXd row;     // n
};

/// How strongly the map from a delta to the raw delta answers: its derivative is -L with
///
///     L = alpha M sum_i b_i(slope_i) b_i(normal_i)^T,   b_i(u)^T = u^T (J_p,i - J_other,i)
///
/// M = I for the transpose and (J^T J + damping^2 I)^-1 for the others; that contacts move along
/// curved surfaces is left out. The result g is the spectral radius of L, exact for one contact or
/// for several of equal b, else at most n^(1/32) times too large: |L^16|^(1/16) with the Frobenius
/// norm, which is never too small. A loop that takes the share `dt / tau` of the way to the raw
/// delta each dt is stable if tau > dt (1 + g) / 2.
/// source docs/theory.md, Loop gain and relaxation
double LoopGainOf(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                  std::span<const GainContact> contacts, const MappingSettings& settings,
                  LoopGainWorkspace& workspace);

/// dt (1 + g) / 2: the relaxation time above which the loop is stable, s.
double LeastRelaxationTime(double gain, double dt);

}  // namespace oca::robot
