// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// A ramp: value = initial until `start`, then initial + slope (t - start).
///
/// An update at exactly `start` marks the corner, so no integrator steps across it.
///
/// in    -
/// out   value    n  `unit`
/// state started  1  1 after `start`, 0 before
/// throws ConfigError if start is negative, a number is not finite or lists differ in length
class RampSource final : public System {
 public:
  static constexpr SystemDoc kDoc{"a ramp in time", "value = initial + slope max(t - start, 0)",
                                  ""};
  struct Params {
    PerComponent slope{1.0};
    PerComponent initial{0.0};
    Period start{};
    std::string unit{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.slope = 2.0, .start = Period(1, 2)}; }

  explicit RampSource(const Params& params);

 private:
  const Params params_;
  const DiscreteState<Vector> started_;
  void CalcValue(double time, VectorView started, MutableVectorView out) const;
  void Initialize(double time, MutableVectorView next) const;
  void Start(MutableVectorView next) const;

 public:
  const Output<Vector> value;
};

}  // namespace oca::systems
