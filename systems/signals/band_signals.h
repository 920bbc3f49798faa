// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/planning/band_memory.h"

namespace oca::systems {

using planning::BandMemory;

/// JSON: {"plans", "start": "request" | "last" | "pause" | "detour" | "random" | "path" | "escape",
/// "clear", "reaches", "stuck", "nearest", "link", "obstacle", "distance", "lack": "none" | "start"
/// | "goal" | "passage" | "own links", "block": "none" | "limit" | "contact" | "way", "block_link",
/// "block_body", "block_amount", "time", "cost", "evaluations", "charged", "overruns"}
using planning::BandReport;

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::BandReport> {
  static constexpr const char* kName = "BandReport";
  static Fault Check(const systems::BandReport& value, Look look);
  static void WriteJson(const systems::BandReport& value, std::string& out);
};

template <>
struct Signal<systems::BandMemory> {
  static constexpr const char* kName = "BandMemory";
  static Fault Check(const systems::BandMemory& value, Look look);
};

}  // namespace oca
