// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/signal.h"
#include "oca/models/motion/trajectory.h"

namespace oca::systems {

/// The whole requested motion, for systems that plan ahead; null if nobody knows it. Copies share
/// it. If `period` is positive the request follows it in samples, from each tick t_k to the next
/// that for t_k + period. JSON: {"points": [{"time", "position", "velocity", "acceleration"}]}, the
/// motion at its key points; read back it is the quintic spline through them, not sampled.
struct RequestAhead {
  std::shared_ptr<const motion::Trajectory> trajectory{};
  Period period{};
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::RequestAhead> {
  static constexpr const char* kName = "RequestAhead";
  static Fault Check(const systems::RequestAhead& /*value*/, Look /*look*/) { return {}; }
  static void WriteJson(const systems::RequestAhead& value, std::string& out);
  static systems::RequestAhead ReadJson(std::string_view text);
};

}  // namespace oca
