// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::bench {

/// A robot without branches for Orocos KDL, called as the report's program calls it: a solver for
/// the pose and one for the Jacobian of each segment, from the base every time.
class KdlArm {
 public:
  explicit KdlArm(const robot::RobotModel& model);

  /// Poses of all links and the Jacobians of all bodies below each other.
  void Calc(const Eigen::VectorXd& q);
  const std::vector<Eigen::Isometry3d>& poses() const { return X_WL_; }
  const Eigen::MatrixXd& jacobian() const { return J_; }

 private:
  const robot::RobotModel& model_;
  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive poses_solver_;
  KDL::ChainJntToJacSolver jacobian_solver_;
  KDL::JntArray q_;
  KDL::Jacobian body_jacobian_;
  std::vector<Eigen::Isometry3d> X_WL_;
  Eigen::MatrixXd J_;
};

}  // namespace oca::bench
