// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"

namespace oca::systems {

// Parameters that many systems have, described once.

/// Describes the parameter model.
template <class P>
void AddModel(Fields<P>& fields) {
  fields.Add("model", &P::model, "", "name of the robot; may be left out if there is but one");
}

/// Describes the parameter period of a system that controls.
template <class P>
void AddControlPeriod(Fields<P>& fields) {
  fields.Add("period", &P::period, "s", "control period").Above(0.0).Required();
}

/// Describes the parameters period and unit of a requested motion.
template <class P>
void AddSampling(Fields<P>& fields) {
  fields
      .Add("period", &P::period, "s",
           "0: continuous in time; > 0: sampled for the end of each period and held")
      .AtLeast(0.0);
  fields.Add("unit", &P::unit, "", "unit of the position");
}

}  // namespace oca::systems
