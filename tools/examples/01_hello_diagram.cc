// SPDX-License-Identifier: BSD-3-Clause
// A diagram from three blocks: a sine, tripled, and what a slow follower makes of it.
#include <cstdio>

#include "oca/framework/simulation/simulator.h"
#include "oca/systems/basics/first_order_lag.h"
#include "oca/systems/basics/gain.h"
#include "oca/systems/basics/sine_source.h"

using oca::systems::FirstOrderLag;
using oca::systems::Gain;
using oca::systems::SineSource;

int main() {
  oca::DiagramBuilder builder;
  const auto& sine = builder.Add<SineSource>("sine", {.amplitude = 2.0, .frequency = 0.25});
  const auto& gain = builder.Add<Gain>("gain", {.gain = 3.0});
  const auto& lag = builder.Add<FirstOrderLag>("lag", {.time_constant = 0.1});
  builder.Connect(sine.value, gain.in);
  builder.Connect(gain.out, lag.in);
  const auto diagram = builder.Build();  // throws with all that is wrong

  oca::Simulator simulator(*diagram);
  simulator.AdvanceTo(1.0);
  const oca::Context& now = simulator.context();
  std::printf("t = %g s: gain %.3f, lag %.3f\n", now.time(), gain.out.Eval(now)[0],
              lag.out.Eval(now)[0]);
}
