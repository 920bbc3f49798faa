// SPDX-License-Identifier: BSD-3-Clause
#include <oca/diagrams/runs/in_memory.h>
#include <oca/diagrams/runs/run.h>
#include <oca/framework/simulation/simulator.h>

#include <cstdio>
#include <exception>

#include "catalogue.h"

/// A diagram in C++: the block and a lambda, wired by hand. Returns the charge after 10 s.
double ChargeLeft() {
  oca::DiagramBuilder builder;
  const auto& monitor = builder.Add<acme::BatteryMonitor>("monitor", {.capacity = 1000.0});
  const auto& swing =
      builder.AddSystem("swing", oca::MakeBlock({.output = {"velocity", 1, "rad/s"}},
                                                [](double t) { return t < 5.0 ? 1.0 : 0.0; }));
  builder.ConnectPorts(swing.FindOutput("velocity"), monitor.velocity);
  const auto diagram = builder.Build();
  oca::Simulator simulator(*diagram);
  simulator.AdvanceTo(10.0);
  return monitor.battery.Eval(simulator.context()).charge;
}

/// Loads and runs the diagram named on the command line; succeeds if it keeps its expectations.
int main(int argc, char** argv) {
  try {
    const auto loaded = oca::loading::LoadDiagram(argc > 1 ? argv[1] : "", {}, acme::Catalogue());
    oca::runs::InMemory series({"monitor.power"}, oca::Period(1, 10));
    const auto result = oca::runs::Run(loaded, {.outputs = {&series}});
    if (result.failure) std::fprintf(stderr, "%s\n", result.failure->message.c_str());
    std::printf("largest power: %.1f %s\n", series.Matrix().maxCoeff(), series.units()[0].c_str());
    std::printf("charge left: %.3f\n", ChargeLeft());
    return !result.failure && result.ExpectationsMet() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
