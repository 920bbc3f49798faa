// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/name.h"

namespace oca::systems {

/// Pairs whose distance does not count, as whoever measures distances leaves them out: a link of
/// the robot, and the id of an obstacle or <model>/<link>. For systems that measure on their own,
/// so that all mean the same. JSON: {"pairs": [[link, other], ...]}
struct IgnoredPairs {
  std::vector<std::pair<models::Name, models::Name>> pairs{};
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::IgnoredPairs> {
  static constexpr const char* kName = "IgnoredPairs";
  static Fault Check(const systems::IgnoredPairs& /*value*/, Look /*look*/) { return {}; }
  static void WriteJson(const systems::IgnoredPairs& value, std::string& out);
  static systems::IgnoredPairs ReadJson(std::string_view text);
};

}  // namespace oca
