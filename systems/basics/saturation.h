// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Keeps each component within bounds: out = min(max(in, lower), upper).
///
/// in    in   n  u
/// out   out  n  u
/// state -
/// throws ConfigError if a bound is not finite, lower > upper, or lists differ in length
class Saturation final : public System {
 public:
  static constexpr SystemDoc kDoc{"keeps a vector within bounds",
                                  "out = min(max(in, lower), upper)", ""};
  struct Params {
    std::optional<PerComponent> lower{};
    std::optional<PerComponent> upper{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.lower = -1.0, .upper = 1.0}; }

  explicit Saturation(const Params& params);

 private:
  const PerComponent lower_;  ///< -infinity for none
  const PerComponent upper_;  ///< +infinity for none
  const Size size_;
  const Unit unit_;
  void CalcOut(VectorView in_value, MutableVectorView out_value) const;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::systems
