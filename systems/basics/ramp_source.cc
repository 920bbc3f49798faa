// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/ramp_source.h"

#include "oca/systems/basics/once.h"

namespace oca::systems {

void RampSource::Params::Describe(Fields<Params>& fields) {
  fields.Add("slope", &Params::slope, "1/s", "rate after the start");
  fields.Add("initial", &Params::initial, "", "value until the start");
  fields.Add("start", &Params::start, "s", "when the ramp begins").AtLeast(0.0);
  fields.Add("unit", &Params::unit, "", "unit of the value; absent: connects to any");
}

RampSource::RampSource(const Params& params)
    : params_(Validated(params)),
      started_(DeclareDiscreteState("started", {1, ""}, 0.0)),
      value(DeclareOutput<Vector, &RampSource::CalcValue>(
          "value",
          {DeclareSize({{"slope", &params_.slope}, {"initial", &params_.initial}}),
           Unit(params_.unit)},
          kTime, started_)) {
  DeclareInitialization<&RampSource::Initialize>(Writes(started_), kTime);
  DeclareUpdate<&RampSource::Start>(internal::Once(params_.start), Writes(started_));
}

void RampSource::CalcValue(double time, VectorView started, MutableVectorView out) const {
  const double elapsed = started[0] > 0.0 ? time - params_.start.seconds() : 0.0;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    out[i] = params_.initial[i] + params_.slope[i] * elapsed;
  }
}

// A run may begin after the start.
void RampSource::Initialize(double time, MutableVectorView next) const {
  next[0] = time > params_.start.seconds() ? 1.0 : 0.0;
}

void RampSource::Start(MutableVectorView next) const { next[0] = 1.0; }

}  // namespace oca::systems
