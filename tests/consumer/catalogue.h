// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <oca/diagrams/files/catalogue.h>
#include <oca/framework/dataflow/function.h>

#include "battery_monitor.h"

namespace acme {

/// The system types of OCA and ours.
inline oca::files::Catalogue Catalogue() {
  auto catalogue = oca::files::Catalogue::Standard();
  catalogue.Add<BatteryMonitor>("BatteryMonitor");

  // A block that needs no class: a lambda.
  catalogue.Add("LowBattery", {"1 while the battery is low", "out = low ? 1 : 0", ""}, [] {
    return oca::MakeBlock({.inputs = {{"battery"}}, .output = {"out", 1}},
                          [](const Battery& battery) { return battery.low ? 1.0 : 0.0; });
  });
  return catalogue;
}

}  // namespace acme
