// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/task_priority_law.h"
#include "oca/systems/methods/velocity_methods.h"

namespace oca::systems {

/// robot::TaskPriorityLaw as a VelocityMethod: far from contact the arm evades without moving its
/// tip off the request (`tip_task` position or pose), close to it evading comes first and the tip
/// has what is left.
///
/// Ports are those of VelocityMethod; share is beta.
///
/// throws ConfigError if there is no such model or link, it has more than 32 joints, or a parameter
///        is out of its bounds; while running if a proximity or a pose is of no link of the model
struct TaskPriorityMethod {
  using Law = robot::TaskPriorityLaw;
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

  static Params Checked(const Params& params);
  static Law LawOf(const Params& params, const robot::RobotModel& model);
};

using TaskPriority = VelocityMethod<TaskPriorityMethod>;

}  // namespace oca::systems
