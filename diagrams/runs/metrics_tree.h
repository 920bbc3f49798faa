// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For the source files that write results as JSON; not installed.

#include <nlohmann/json.hpp>
#include <optional>

#include "oca/systems/signals/motion_metrics_value.h"

namespace oca::runs {

/// {} if there are none.
nlohmann::ordered_json MetricsTree(const std::optional<systems::MotionMetricsValue>& metrics);
/// The same back; keys that are left out have no value. Empty of something else.
/// throws nlohmann's exception if it is no object
std::optional<systems::MotionMetricsValue> ReadMetrics(const nlohmann::ordered_json& tree);

}  // namespace oca::runs
