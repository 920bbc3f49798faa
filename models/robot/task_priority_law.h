// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "oca/models/robot/avoidance_velocity.h"
#include "oca/models/robot/filtered_inverse.h"
#include "oca/models/robot/proximity.h"

namespace oca::robot {

/// Task priority: far from contact the arm evades without moving its tip off the request, close to
/// it evading comes first and the tip has what is left. The two swap smoothly.
///
///     u = r + (1 - beta) [J_o N_e]+ e + beta J_o+ e
///     e_i = max(0, n_i^T v_i + speed(d_i) - J_oi r),   J_oi = n_i^T J at point_on_link
///     speed(d) = min(approach_gain (safe_distance - d), retreat_speed)
///     beta = max_i fade(d_i, contact_distance, swap_distance)
///
/// r is `wish`, the joint velocity that follows the request, and N_e the motions that keep the tip
/// link's velocity J_e r. This is Maciejewski and Klein's law with the request's own joint motion,
/// instead of J_e+ xdot_e, as the particular solution of the first task: r holds more than the
/// tip's motion, and without obstacles the arm moves as requested. With a tip task that takes all
/// freedom (position with three joints, pose with six) nothing is done before beta rises.
///
/// A proximity asks for its speed only as far as the request falls short of it, so that a retreat
/// is never held back. Row i counts with the weight
///
///     a_i = fade(d_i, activation_distance / 2, activation_distance) min(1, e_i / 0.1 m/s)
///           (1 + (0.05 m / (max(d_i, 0) + 0.01 m))^2)
///
/// (of own links all distances shrink in proportion, so that a row counts from its range on)
///
/// in both (weighted, damped) pseudo-inverses, so that the answer is continuous as rows enter and
/// leave, of any number. Rows that contradict each other share what cannot be had, the nearest has
/// most of it: an average, where a safety filter keeps each row. fade goes from 1 at its second
/// argument to 0 at its third; damping is Chiaverini's.
///
/// source Maciejewski, Klein 1985, eq. (15), Obstacle avoidance for kinematically redundant
///        manipulators, IJRR 4(3); Chiaverini 1997; docs/theory.md
struct TaskPriorityLaw {
  int tip;                     ///< the link whose motion is kept
  bool keeps_orientation;      ///< of the tip, beside its position
  double safe_distance;        ///< m, that is aimed at
  double approach_gain;        ///< 1/s
  double retreat_speed;        ///< m/s
  double activation_distance;  ///< m, from where on a proximity counts
  double swap_distance;        ///< m, above contact_distance
  double contact_distance;     ///< m
  Damping damping;             ///< m/rad

  /// X_WL are the poses of the model's links; the share of the result is beta. throws ModelError if
  /// a proximity is of no link of the model
  void Choose(const RobotModel& model, const ProximitySet& set,
              std::span<const Eigen::Isometry3d> X_WL,
              const Eigen::Ref<const Eigen::VectorXd>& wish, AvoidanceVelocity& result) const;
};

}  // namespace oca::robot
