// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/basics/delay_line.h"

namespace oca::systems {

/// Delays its input by a whole number of periods: out(t_k) = in(t_k - delay) at every tick t_k.
///
/// Between ticks the value is held: out = in(t_{k+1} - delay) for t in (t_k, t_{k+1}]. So whoever
/// looks at a tick, an update or a publish, sees exactly the input of `delay` earlier; with `delay`
/// of one period it is a ZeroOrderHold. Until the first sample arrives, out = initial. Give `delay`
/// in seconds or `steps`, a number of periods. It breaks algebraic loops.
///
/// in    in    n      u
/// out   out   n      u
/// state line  steps  the last samples
/// throws ConfigError if period is not positive, or unless one of delay and steps is given and is
///        1 to kMostSteps whole periods; if initial is not finite
class Delay final : public System {
 public:
  static constexpr int kMostSteps = 10000;
  static constexpr SystemDoc kDoc{"delays its input by a whole number of periods",
                                  "out(t_k) = in(t_k - delay)", ""};
  struct Params {
    Period period{};
    Period delay{};
    int steps{0};
    PerComponent initial{0.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100), .delay = Period(3, 100)}; }

  explicit Delay(const Params& params);

 private:
  const Params params_;
  const int steps_;
  const Size size_;
  const Unit unit_;
  const DiscreteState<DelayLine> line_;
  void CalcOut(const DelayLine& line, MutableVectorView out_value) const;
  void Update(VectorView in_value, DelayLine& next) const;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::systems
