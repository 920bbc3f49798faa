// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/integrator_options.h"

#include "oca/framework/dataflow/params.h"

namespace oca {

std::span<const char* const> EnumNames(IntegratorKind) {
  static constexpr const char* kNames[] = {"erk_dp5",   "erk_bs3",   "cvode_adams",
                                           "cvode_bdf", "fixed_dp5", "fixed_rk4"};
  return kNames;
}

void Tolerances::Describe(Fields<Tolerances>& fields) {
  fields.Add("relative", &Tolerances::relative, "", "error a step, relative to the state")
      .Above(0.0)
      .AtMost(1.0);
  fields.Add("absolute", &Tolerances::absolute, "", "error a step, in the unit of the state")
      .Above(0.0);
}

void IntegratorOptions::Describe(Fields<IntegratorOptions>& fields) {
  using O = IntegratorOptions;
  fields.Add("integrator", &O::integrator, "", "method for continuous state");
  fields
      .Add("relative_tolerance", &O::relative_tolerance, "", "error a step, relative to the state")
      .Above(0.0)
      .AtMost(1.0);
  fields
      .Add("absolute_tolerance", &O::absolute_tolerance, "",
           "error a step, in the unit of the state")
      .Above(0.0);
  fields.Add("max_step", &O::max_step, "s", "longest step of an adaptive integrator").Above(0.0);
  fields.Add("fixed_step", &O::fixed_step, "s", "longest step of a fixed-step integrator")
      .Above(0.0);
  fields.Add("max_steps", &O::max_steps, "", "steps allowed between two events").AtLeast(1.0);
}

}  // namespace oca
