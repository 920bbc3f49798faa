// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/robot/clear_motion.h"

namespace oca::systems {

/// JSON: {"clear_for", "bodies", "own_links", "standing_for", "standing"}; the last two may be left
/// out
using robot::ClearMotion;

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::ClearMotion> {
  static constexpr const char* kName = "ClearMotion";
  static Fault Check(const systems::ClearMotion& value, Look look);
  static void WriteJson(const systems::ClearMotion& value, std::string& out);
  static systems::ClearMotion ReadJson(std::string_view text);
};

}  // namespace oca
