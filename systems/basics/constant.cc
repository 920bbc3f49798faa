// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/constant.h"

namespace oca::systems {
void Constant::Params::Describe(Fields<Params>& fields) {
  fields.Add("value", &Params::value, "", "the vector, or one number for every component")
      .Required();
  fields.Add("unit", &Params::unit, "", "unit of the value; absent: connects to any");
}

Constant::Constant(const Params& params)
    : params_(Validated(params)),
      value(DeclareOutput<Vector, &Constant::CalcValue>(
          "value", {DeclareSize({{"value", &params_.value}}), Unit(params_.unit)})) {}

void Constant::CalcValue(MutableVectorView out) const {
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = params_.value[i];
}

}  // namespace oca::systems
