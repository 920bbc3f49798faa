// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

class Clearance;

/// The link at the end of the arm: the one that carries no other, attached objects apart.
/// throws ModelError naming them if there are several
int TipLink(const RobotModel& model);

struct InverseKinematicsSettings {
  double position_tolerance{1e-6};  // m
  double rotation_tolerance{1e-6};  // rad
  int starts{200};                  // at most; the given posture, then random ones
  int solutions{1};                 // how many are sought, of which the best is taken
  std::uint64_t seed{0};
  double clearance{0.0};     // m, wanted from what a Clearance knows; 0: it is not looked at
  bool turns_freely{false};  // the origin of the link shall be there, turned however it is
};

/// A posture, and what it is worth. Of a goal that is out of reach it is the one whose PoseError
/// is the shortest found, metres and radians taken as equal.
struct PostureSolution {
  Eigen::VectorXd q;           // n; within the limits
  bool reached{false};         // both errors are within their tolerances
  double position_error{0.0};  // m
  double rotation_error{0.0};  // rad; 0 where it turns freely
  double change{0.0};          // |q - start|
  double clearance{0.0};       // m, the least; the wanted one if that is less
  int starts{0};               // that were tried
};

/// Joint positions within the limits that bring `link` to the pose X_WG, near the posture `start`.
///
/// Levenberg-Marquardt on the PoseError from `start`, then from random postures until as many
/// solutions as wanted are found. A limit is kept by looking at the pose of the clamped position,
/// with a pull back for what lies beyond. Each solution is drawn, along the postures that also
/// reach the goal, towards `start` (residuals w (q - start), w = 0.1, 0.01, 0.001) and away from
/// what is nearer than `clearance` (a residual a link, 0.3 (clearance - distance) where that is
/// positive); the pose has the last word. Best is what lacks least of the clearance, among equals
/// the nearest to `start`: of one solution the posture that the arm slides into, of twenty the
/// nearest there is in nine of ten cases. Joints that do not carry `link` stay where `start` has
/// them. The same arguments give the same answer.
///
/// `surroundings` speaks of `model` itself, and is left at some position; null: nothing is near.
/// throws ModelError if `start`, the pose or a setting is not finite or of wrong size or sign
/// source Ceres Solver's TinySolver; Madsen, Nielsen, Tingleff, Methods for Non-Linear Least
///        Squares Problems, 2004, algorithm 3.16
PostureSolution SolveInverseKinematics(const RobotModel& model, int link,
                                       const Eigen::Isometry3d& X_WG,
                                       const Eigen::Ref<const Eigen::VectorXd>& start,
                                       const InverseKinematicsSettings& settings = {},
                                       Clearance* surroundings = nullptr);

}  // namespace oca::robot
