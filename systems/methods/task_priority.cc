// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/task_priority.h"

#include "oca/systems/basics/require.h"

namespace oca::systems {

void TaskPriorityMethod::Params::Describe(Fields<Params>& fields) {
  AddModelAndTip(fields, "link whose motion is kept; may be left out if one is last");
  fields.Add("tip_task", &Params::tip_task, "", "what of it is kept: position or pose");
  fields.Add("safe_distance", &Params::safe_distance, "m", "distance that is aimed at").AtLeast(0);
  fields
      .Add("approach_gain", &Params::approach_gain, "1/s",
           "share of the distance left that may be used up in a second")
      .Above(0.0);
  fields
      .Add("retreat_speed", &Params::retreat_speed, "m/s",
           "largest speed of a retreat from an obstacle at rest")
      .AtLeast(0.0);
  fields
      .Add("activation_distance", &Params::activation_distance, "m",
           "from where on a proximity counts; in full at half of it")
      .Above(0.0);
  fields
      .Add("swap_distance", &Params::swap_distance, "m",
           "from where on the roles of tip and avoidance swap; above contact_distance")
      .Above(0.0);
  fields.Add("contact_distance", &Params::contact_distance, "m", "where they have swapped")
      .AtLeast(0.0);
  AddDamping(fields);
}

TaskPriorityMethod::Params TaskPriorityMethod::Checked(const Params& params) {
  WithDamping(params);
  RequireAbove("swap_distance", params.swap_distance, params.contact_distance);
  return params;
}

robot::TaskPriorityLaw TaskPriorityMethod::LawOf(const Params& params,
                                                 const robot::RobotModel& model) {
  return {.tip = TipNumber(model, params.tip),
          .keeps_orientation = params.tip_task == TipTask::kPose,
          .safe_distance = params.safe_distance,
          .approach_gain = params.approach_gain,
          .retreat_speed = params.retreat_speed,
          .activation_distance = params.activation_distance,
          .swap_distance = params.swap_distance,
          .contact_distance = params.contact_distance,
          .damping = {params.most_damping, params.damping_threshold}};
}

}  // namespace oca::systems
