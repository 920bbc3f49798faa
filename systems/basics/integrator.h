// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Integrates its input over time: x' = in, out = x.
///
/// in    in   n  u/s
/// out   out  n  u    `unit`, or settled by what is connected
/// state x    n  u    continuous
/// throws ConfigError if initial is not finite or empty
class Integrator final : public System {
 public:
  static constexpr SystemDoc kDoc{"integrates its input over time", "x' = in; out = x", ""};
  struct Params {
    PerComponent initial{0.0};
    std::string unit{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.initial = 1.0}; }

  explicit Integrator(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const ContinuousState x_;
  void CalcDerivative(VectorView in_value, MutableVectorView derivative) const;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::systems
