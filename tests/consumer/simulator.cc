// SPDX-License-Identifier: BSD-3-Clause
#include "battery_monitor.h"
#include "framework/function.h"
#include "tools/simulator_main.h"

int main(int argc, char** argv) {
  auto catalogue = oca::diagrams::Catalogue::Standard();
  catalogue.Add<acme::BatteryMonitor>("BatteryMonitor");

  // A block that needs no class: a lambda.
  catalogue.Add("LowBattery", {"1 while the battery is low", "out = low ? 1 : 0", ""}, [] {
    return oca::MakeBlock({.inputs = {{"battery"}}, .output = {"out", 1}},
                          [](const acme::Battery& battery) { return battery.low ? 1.0 : 0.0; });
  });
  return oca::tools::SimulatorMain(argc, argv, catalogue);
}
