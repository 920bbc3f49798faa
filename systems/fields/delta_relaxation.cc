// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/delta_relaxation.h"

#include <algorithm>

#include "oca/systems/signals/roles.h"

namespace oca::systems {
void DeltaRelaxation::Params::Describe(Fields<Params>& fields) {
  fields
      .Add("relaxation_time", &Params::relaxation_time, "s",
           "time constant of the lag; 0 passes the delta through")
      .AtLeast(0.0);
  fields.Add("period", &Params::period, "s", "time between updates").Above(0.0).Required();
}

DeltaRelaxation::DeltaRelaxation(const Params& params)
    : params_(Validated(params)),
      size_(DeclareSize()),
      unit_(DeclareUnit()),
      x_(DeclareDiscreteState("x", {size_, unit_}, 0.0)),
      delta(DeclareInput<Vector>("delta", {size_, unit_})),
      relaxation_time(DeclareOptionalInput<Vector>("relaxation_time", {1, "s"})),
      held(DeclareOptionalInput<Vector>("held", {size_, unit_})),
      relaxed_delta(DeclareOutput<Vector, &DeltaRelaxation::CalcRelaxed>(
          "relaxed_delta", {size_, unit_}, delta, relaxation_time, held, x_)) {
  DeclareUpdate<&DeltaRelaxation::Update>(Every{params.period}, Writes(x_), relaxed_delta);
  DeclareRole(CarriesDelta{.in = delta,
                           .out = relaxed_delta,
                           .relaxation_time = params_.relaxation_time,
                           .adapts = relaxation_time});
}

void DeltaRelaxation::CalcRelaxed(VectorView delta_value, OptionalVector time, OptionalVector left,
                                  VectorView x, MutableVectorView relaxed) const {
  const double period = params_.period.seconds();
  const double relaxation = std::max(params_.relaxation_time, time ? (*time)[0] : 0.0);
  const VectorView from = left ? *left : x;
  // A factor of one must pass the delta bit by bit; x + (delta - x) may round.
  if (relaxation <= period) {
    relaxed = delta_value;
  } else {
    relaxed = from + period / relaxation * (delta_value - from);
  }
}

void DeltaRelaxation::Update(VectorView relaxed, MutableVectorView next) const { next = relaxed; }

}  // namespace oca::systems
