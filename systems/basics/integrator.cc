// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/integrator.h"

namespace oca::systems {
void Integrator::Params::Describe(Fields<Params>& fields) {
  fields.Add("initial", &Params::initial, "", "output at the start");
  fields.Add("unit", &Params::unit, "", "unit of the output; absent: from the connections");
}

Integrator::Integrator(const Params& params)
    : params_(Validated(params)),
      size_(DeclareSize({{"initial", &params_.initial}})),
      unit_(params_.unit.empty() ? DeclareUnit() : Unit(params_.unit)),
      x_(DeclareContinuousState("x", {size_, unit_}, params_.initial)),
      in(DeclareInput<Vector>("in", {size_, unit_.Rate()})),
      out(DeclareStateOutput("out", x_)) {
  DeclareDerivative<&Integrator::CalcDerivative>(x_, in);
}

void Integrator::CalcDerivative(VectorView in_value, MutableVectorView derivative) const {
  derivative = in_value;
}

}  // namespace oca::systems
