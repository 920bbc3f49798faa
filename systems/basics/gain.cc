// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/gain.h"

namespace oca::systems {
void Gain::Params::Describe(Fields<Params>& fields) {
  fields.Add("gain", &Params::gain, "", "factor of each component").Required();
}

Gain::Gain(const Params& params)
    : params_(Validated(params)),
      size_(DeclareSize({{"gain", &params_.gain}})),
      in(DeclareInput<Vector>("in", {size_})),
      out(DeclareOutput<Vector, &Gain::CalcOut>("out", {size_}, in)) {}

void Gain::CalcOut(VectorView in_value, MutableVectorView out_value) const {
  for (Eigen::Index i = 0; i < in_value.size(); ++i) out_value[i] = params_.gain[i] * in_value[i];
}

}  // namespace oca::systems
