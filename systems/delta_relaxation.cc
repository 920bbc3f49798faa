// SPDX-License-Identifier: BSD-3-Clause
#include "systems/delta_relaxation.h"

#include "systems/require.h"

namespace oca::systems {
namespace {

double FactorOf(const DeltaRelaxation::Params& params) {
  RequireAtLeast("relaxation_time", params.relaxation_time, 0.0);
  RequirePositive("period", params.period);
  const double period = params.period.seconds();
  return params.relaxation_time <= period ? 1.0 : period / params.relaxation_time;
}

}  // namespace

void DeltaRelaxation::Params::Describe(Fields<Params>& fields) {
  fields
      .Add("relaxation_time", &Params::relaxation_time, "s",
           "time constant of the lag; 0 passes the delta through")
      .AtLeast(0.0);
  fields.Add("period", &Params::period, "s", "time between updates").Above(0.0).Required();
}

DeltaRelaxation::DeltaRelaxation(const Params& params)
    : factor_(FactorOf(params)),
      size_(DeclareSize()),
      unit_(DeclareUnit()),
      x_(DeclareDiscreteState("x", {size_, unit_}, 0.0)),
      delta(DeclareInput<Vector>("delta", {size_, unit_})),
      relaxed_delta(DeclareOutput<Vector, &DeltaRelaxation::CalcRelaxed>(
          "relaxed_delta", {size_, unit_}, delta, x_)) {
  DeclareUpdate<&DeltaRelaxation::Update>(Every{params.period}, Writes(x_), relaxed_delta);
}

void DeltaRelaxation::CalcRelaxed(VectorView delta_value, VectorView x,
                                  MutableVectorView relaxed) const {
  // A factor of one must pass the delta bit by bit; x + (delta - x) may round.
  if (factor_ == 1.0) {
    relaxed = delta_value;
  } else {
    relaxed = x + factor_ * (delta_value - x);
  }
}

void DeltaRelaxation::Update(VectorView relaxed, MutableVectorView next) const { next = relaxed; }

}  // namespace oca::systems
