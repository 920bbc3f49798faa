// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Force (N) and torque (Nm) on a body, world axes; the torque is about the origin of the body's
/// link, which lies on the joint that leads to it. source report section 3.3; docs/theory.md
struct BodyWrench {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};
};

enum class MappingMethod {
  kTranspose,      // delta = alpha J^T w
  kPseudoInverse,  // delta = alpha (J^T J)^-1 J^T w
  kDamped          // delta = alpha (J^T J + damping^2 I)^-1 J^T w
};

/// By which diagonal entries grow, each by its own size, where J^T J cannot be factored.
inline constexpr double kRegularisation = 1e-9;

enum class MappingStatus {
  kOk,
  /// J^T J is singular to working precision (a column of J lies within about 1e-6 rad of the
  /// span of the others); the answer is the damped one with damping^2 = 1e-9 max diag(J^T J).
  kRegularised,
  /// A wrench or a pose is not finite; delta is zero.
  kNotFinite
};

struct MappingSettings {
  MappingMethod method{MappingMethod::kPseudoInverse};
  double alpha{1.0};
  double damping{0.0};  // lambda >= 0; shares its unit with J: m for lengths, 1 for angles
};

/// What a mapping needs besides its arguments, allocated once for a model.
struct MappingWorkspace {
  explicit MappingWorkspace(const RobotModel& model);

  /// The bodies at and beyond a link, as masses of one at their origins with one unit of rotary
  /// inertia each: their number, first and second moment about the link's origin.
  struct Composite {
    double count;
    Eigen::Vector3d first;
    Eigen::Matrix3d second;
  };
  std::vector<BodyWrench> link_wrenches;  // one a link: sum over the bodies at and beyond it
  std::vector<Composite> composites;      // one a link
  Eigen::MatrixXd normal;                 // n x n, J^T J
  Eigen::LLT<Eigen::MatrixXd> factor;     // n x n
};

// J is the stacked Jacobian (see StackedJacobian) and w the stacked wrenches, one a body in the
// order of RobotModel::bodies(). J is never formed: J^T w is a sweep of moments from the tips to
// the root, and J^T J is the inertia matrix of an arm that has a unit mass and a unit rotary
// inertia at each joint, so the composite-rigid-body algorithm gives it.
// source Featherstone, Rigid Body Dynamics Algorithms, 2008, table 6.2
// None of these allocates; sizes are asserted.

/// J^T w, one entry a position.
void MultiplyTransposed(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                        std::span<const BodyWrench> wrenches, MappingWorkspace& workspace,
                        Eigen::Ref<Eigen::VectorXd> Jt_w);

/// J^T J into workspace.normal.
void ComputeNormalMatrix(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                         MappingWorkspace& workspace);

/// Joint offsets `delta` (rad, m) from body wrenches. source report eq. (2.8), (2.9), (3.4)
///
/// J has full column rank in exact arithmetic, since each joint turns or shifts its own body; the
/// status tells when lengths differ so much that rounding hides it.
MappingStatus MapWrenches(const RobotModel& model, std::span<const Eigen::Isometry3d> X_WL,
                          std::span<const BodyWrench> wrenches, const MappingSettings& settings,
                          MappingWorkspace& workspace, Eigen::Ref<Eigen::VectorXd> delta);

}  // namespace oca::robot
