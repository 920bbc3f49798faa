// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/judging/avoidance_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "oca/framework/dataflow/log.h"

namespace oca::systems {

void AvoidanceLog::Params::Describe(Fields<Params>& fields) {
  fields.Add("period", &Params::period, "s", "time between lines").Above(0.0).Required();
  fields.Add("enabled", &Params::enabled, "", "false: nothing is written");
}

AvoidanceLog::AvoidanceLog(const Params& params)
    : proximities(DeclareOptionalInput<ProximitySet>("proximities")),
      forces(DeclareOptionalInput<LinkForceSet>("forces")),
      delta(DeclareOptionalInput<Vector>("delta", {DeclareSize(), Unit::Any()})) {
  Validated(params);
  if (!params.enabled) return;
  DeclarePublish<&AvoidanceLog::WriteLine>(Every{params.period}, kTime, kLog, proximities, forces,
                                           delta);
}

void AvoidanceLog::WriteLine(double time, Log& log, const ProximitySet* proximity_set,
                             const LinkForceSet* force_set,
                             std::optional<VectorView> delta_value) const {
  if (!log.enabled(LogLevel::kDebug)) return;
  fmt::memory_buffer line;  // on the stack up to 500 characters
  const auto out = std::back_inserter(line);
  if (proximity_set != nullptr) {
    const auto& all = proximity_set->proximities;
    const auto closest = std::min_element(
        all.begin(), all.end(),
        [](const Proximity& a, const Proximity& b) { return a.distance < b.distance; });
    if (closest == all.end()) {
      fmt::format_to(out, "closest -");
    } else {
      fmt::format_to(out, "closest {} - {} {:.4f} m", closest->link.text(),
                     closest->obstacle.text(), closest->distance);
    }
  }
  if (force_set != nullptr) {
    double largest = 0.0;
    for (const LinkForce& force : force_set->forces) {
      largest = std::max(largest, force.force.norm());
    }
    fmt::format_to(out, "{}force {:.4g} N", line.size() == 0 ? "" : ", ", largest);
  }
  if (delta_value) {
    fmt::format_to(out, "{}delta {:.4g}", line.size() == 0 ? "" : ", ",
                   delta_value->size() == 0 ? 0.0 : delta_value->cwiseAbs().maxCoeff());
  }
  log.Write(LogLevel::kDebug, time, {line.data(), line.size()});
}

}  // namespace oca::systems
