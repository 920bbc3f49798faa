// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/name.h"

namespace oca::systems {

/// How long a planned motion is known to be clear, and of what: not of anything else.
/// JSON: {"clear_for", "bodies", "own_links"}
struct ClearMotion {
  double clear_for{0.0};               ///< s; from now on, 0: not known to be
  std::vector<models::Name> bodies{};  ///< obstacles that it was planned with
  bool own_links{false};               ///< and the links of the robot itself

  bool Knows(models::Name obstacle, bool own_link) const;
};

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
