// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/zero_order_hold.h"

namespace oca::systems {
void ZeroOrderHold::Params::Describe(Fields<Params>& fields) {
  fields.Add("period", &Params::period, "s", "time between samples").Above(0.0).Required();
  fields.Add("initial", &Params::initial, "", "output before the first sample");
}

ZeroOrderHold::ZeroOrderHold(const Params& params)
    : params_(Validated(params)),
      size_(DeclareSize({{"initial", &params_.initial}})),
      unit_(DeclareUnit()),
      x_(DeclareDiscreteState("x", {size_, unit_}, params_.initial)),
      in(DeclareInput<Vector>("in", {size_, unit_})),
      out(DeclareStateOutput("out", x_)) {
  DeclareUpdate<&ZeroOrderHold::Update>(Every{params_.period}, Writes(x_), in);
}

void ZeroOrderHold::Update(VectorView in_value, MutableVectorView next) const { next = in_value; }

}  // namespace oca::systems
