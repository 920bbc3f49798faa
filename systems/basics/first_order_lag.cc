// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/first_order_lag.h"

namespace oca::systems {
void FirstOrderLag::Params::Describe(Fields<Params>& fields) {
  fields.Add("time_constant", &Params::time_constant, "s", "time to cover 63 % of a step")
      .Above(0.0)
      .Required();
  fields.Add("initial", &Params::initial, "", "output at the start");
}

FirstOrderLag::FirstOrderLag(const Params& params)
    : params_(Validated(params)),
      size_(
          DeclareSize({{"time_constant", &params_.time_constant}, {"initial", &params_.initial}})),
      unit_(DeclareUnit()),
      x_(DeclareContinuousState("x", {size_, unit_}, params_.initial)),
      in(DeclareInput<Vector>("in", {size_, unit_})),
      out(DeclareStateOutput("out", x_)) {
  DeclareDerivative<&FirstOrderLag::CalcDerivative>(x_, in, x_);
}

void FirstOrderLag::CalcDerivative(VectorView in_value, VectorView x,
                                   MutableVectorView derivative) const {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    derivative[i] = (in_value[i] - x[i]) / params_.time_constant[i];
  }
}

}  // namespace oca::systems
