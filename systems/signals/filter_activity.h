// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/robot/filter_activity.h"

namespace oca::systems {

/// JSON: {"status": "optimal" | "iteration_limit" | "not_proven" | "invalid", "rows", "dropped",
/// "yields", "slack", "margin", "kkt_residual", "gap", "bounds": [{"kind": "distance" | "recovery"
/// | "unmovable", "link", "obstacle", "multiplier", "slack"}, {"kind": "lower" | "upper", "joint",
/// "limit", "multiplier"}]}
using robot::FilterActivity;
using robot::FilterBound;

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::FilterActivity> {
  static constexpr const char* kName = "FilterActivity";
  static Fault Check(const systems::FilterActivity& value, Look look);
  static void WriteJson(const systems::FilterActivity& value, std::string& out);
};

}  // namespace oca
