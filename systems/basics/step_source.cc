// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/step_source.h"

#include "oca/systems/basics/once.h"

namespace oca::systems {
namespace {

void Fill(const PerComponent& values, MutableVectorView out) {
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = values[i];
}

}  // namespace

void StepSource::Params::Describe(Fields<Params>& fields) {
  fields.Add("time", &Params::time, "s", "when the value switches").AtLeast(0.0);
  fields.Add("initial", &Params::initial, "", "value up to the step");
  fields.Add("final", &Params::final, "", "value after the step");
  fields.Add("unit", &Params::unit, "", "unit of the value; absent: connects to any");
}

StepSource::StepSource(const Params& params)
    : params_(Validated(params)),
      value_(DeclareDiscreteState(
          "value",
          {DeclareSize({{"initial", &params_.initial}, {"final", &params_.final}}),
           Unit(params_.unit)},
          params_.initial)),
      value(DeclareStateOutput("value", value_)) {
  DeclareInitialization<&StepSource::Initialize>(Writes(value_), kTime);
  DeclareUpdate<&StepSource::Switch>(internal::Once(params_.time), Writes(value_));
}

// A run may begin after the step.
void StepSource::Initialize(double time, MutableVectorView next) const {
  Fill(time <= params_.time.seconds() ? params_.initial : params_.final, next);
}

void StepSource::Switch(MutableVectorView next) const { Fill(params_.final, next); }

}  // namespace oca::systems
