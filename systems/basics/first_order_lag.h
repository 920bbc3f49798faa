// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Follows its input with a first-order lag: time_constant x' = in - x, out = x.
///
/// in    in   n  u
/// out   out  n  u
/// state x    n  u  continuous
/// throws ConfigError if time_constant is not positive or initial is not finite
class FirstOrderLag final : public System {
 public:
  static constexpr SystemDoc kDoc{"follows its input with a first-order lag",
                                  "time_constant x' = in - x; out = x", ""};
  struct Params {
    PerComponent time_constant{1.0};
    PerComponent initial{0.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.time_constant = 0.05}; }

  explicit FirstOrderLag(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const ContinuousState x_;
  void CalcDerivative(VectorView in_value, VectorView x, MutableVectorView derivative) const;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::systems
