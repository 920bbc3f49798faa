// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/flacco_de_luca.h"

namespace oca::systems {

void FlaccoDeLucaMethod::Params::Describe(Fields<Params>& fields) {
  AddModelAndTip(fields, "link that is repulsed; may be left out if one is last");
  fields.Add("repulsion", &Params::repulsion, "",
             "which links are repulsed: tip, as published, or all");
  fields.Add("repulsion_speed", &Params::repulsion_speed, "m/s", "of a repulsed point near contact")
      .AtLeast(0.0);
  fields
      .Add("influence_distance", &Params::influence_distance, "m",
           "up to which obstacles count; half of the effect is at half of it")
      .Above(0.0);
  fields.Add("alpha", &Params::alpha, "", "steepness of the risk over the distance").Above(0.0);
  fields
      .Add("max_joint_velocity", &Params::max_joint_velocity, "rad/s",
           "bound on every joint's speed, beside the model's limits")
      .Above(0.0);
  AddDamping(fields);
}

robot::FlaccoDeLucaLaw FlaccoDeLucaMethod::LawOf(const Params& params,
                                                 const robot::RobotModel& model) {
  return {.tip = TipNumber(model, params.tip),
          .all_links = params.repulsion == Repulsion::kAll,
          .repulsion_speed = params.repulsion_speed,
          .influence_distance = params.influence_distance,
          .alpha = params.alpha,
          .max_joint_velocity = params.max_joint_velocity,
          .damping = {params.most_damping, params.damping_threshold}};
}

}  // namespace oca::systems
