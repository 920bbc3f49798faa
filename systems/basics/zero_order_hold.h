// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Samples its input every `period` and holds it: out = in(t_k) for t in (t_k, t_k + period].
///
/// At a tick itself, updates and publishes still see the value held before; until the first tick
/// out = initial. It breaks algebraic loops.
///
/// in    in   n  u
/// out   out  n  u
/// state x    n  u  the sample
/// throws ConfigError if period is not positive or initial is not finite
class ZeroOrderHold final : public System {
 public:
  static constexpr SystemDoc kDoc{"samples its input and holds it",
                                  "out = in(t_k) from t_k to t_k + period", ""};
  struct Params {
    Period period{};
    PerComponent initial{0.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  explicit ZeroOrderHold(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const DiscreteState<Vector> x_;
  void Update(VectorView in_value, MutableVectorView next) const;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::systems
