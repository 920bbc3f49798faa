// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/filtered_inverse.h"
#include "oca/systems/methods/velocity_methods.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Task priority: far from contact the arm evades without moving its tip off the request, close to
/// it evading comes first and the tip has what is left. The two swap smoothly.
///
///     u = r + (1 - beta) [J_o N_e]+ e + beta J_o+ e
///     e_i = max(0, n_i^T v_i + speed(d_i) - J_oi r),   J_oi = n_i^T J at point_on_link
///     speed(d) = min(approach_gain (safe_distance - d), retreat_speed)
///     beta = max_i fade(d_i, contact_distance, swap_distance)
///
/// r is `wish`, the joint velocity that follows the request, and N_e the motions that keep the tip
/// link's velocity J_e r (`tip_task` position or pose). This is Maciejewski and Klein's law with
/// the request's own joint motion, instead of J_e+ xdot_e, as the particular solution of the first
/// task: r holds more than the tip's motion, and without obstacles the arm moves as requested. With
/// a tip task that takes all freedom (position with three joints, pose with six) nothing is done
/// before beta rises.
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
/// most of it: an average, where a SafetyFilter keeps each row. fade goes from 1 at its second
/// argument to 0 at its third; damping is Chiaverini's, robot::Damping.
///
/// Ports are those of VelocityMethod; share is beta.
///
/// throws ConfigError if there is no such model or link, it has more than 32 joints, or a parameter
///        is out of its bounds; while running if a proximity or a pose is of no link of the model
/// source Maciejewski, Klein 1985, eq. (15), Obstacle avoidance for kinematically redundant
///        manipulators, IJRR 4(3); Chiaverini 1997; docs/theory.md
class TaskPriorityLaw {
 public:
  static constexpr SystemDoc kDoc{
      "evades in the null space of the tip, and first of all close to contact",
      "u = r + (1 - beta) [J_o N_e]+ e + beta J_o+ e, e = max(0, n^T v_obstacle + speed(d) - J_o "
      "r)",
      "Maciejewski, Klein 1985, IJRR 4(3)"};
  enum class TipTask { kPosition, kPose };
  friend std::span<const char* const> EnumNames(TipTask) {
    static constexpr std::array kNames{"position", "pose"};
    return kNames;
  }
  struct Params {
    std::string model{};
    std::string tip{};
    TipTask tip_task{TipTask::kPosition};
    double safe_distance{0.05};
    double approach_gain{2.0};
    double retreat_speed{0.5};
    double activation_distance{0.4};
    double swap_distance{0.25};
    double contact_distance{0.1};
    double most_damping{0.05};
    double damping_threshold{0.1};
    static void Describe(Fields<Params>& fields);
  };
  static constexpr const char* kHow = "evading";

  TaskPriorityLaw(const Params& params, const ModelSet& models);

  const robot::RobotModel& model() const { return *model_; }
  void Choose(const ProximitySet& set, std::span<const Eigen::Isometry3d> X_WL, VectorView wish,
              AvoidanceVelocity& result) const;

 private:
  struct Rows;  ///< the normal equations of the proximities' rows
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const int tip_;
  const robot::Damping damping_;

  robot::JointMatrix TipTaskMatrix(std::span<const Eigen::Isometry3d> X_WL) const;
  void AddRow(const Proximity& proximity, std::span<const Eigen::Isometry3d> X_WL, VectorView wish,
              Rows& rows) const;
};

using TaskPriority = VelocityMethod<TaskPriorityLaw>;

}  // namespace oca::systems
