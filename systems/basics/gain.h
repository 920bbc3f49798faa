// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Multiplies a vector: out = gain * in, component by component.
///
/// in    in   n  any
/// out   out  n  any (the gain may carry a unit)
/// state -
class Gain final : public System {
 public:
  static constexpr SystemDoc kDoc{"multiplies a vector", "out_i = gain_i in_i", ""};
  struct Params {
    PerComponent gain{1.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.gain = 2.0}; }

  /// throws ConfigError if a gain is not finite.
  explicit Gain(const Params& params);

 private:
  const Params params_;
  const Size size_;
  void CalcOut(VectorView in, MutableVectorView out) const;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::systems
