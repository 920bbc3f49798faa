// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "oca/models/name.h"

namespace oca::robot {

/// How long a planned motion is known to be clear, and of what: not of anything else.
///
/// What stands where it stood is known by itself: that something else turns or appears says nothing
/// against what was planned past it.
struct ClearMotion {
  double clear_for{0.0};               ///< s; from now on, 0: not known to be
  std::vector<models::Name> bodies{};  ///< obstacles that it was planned with
  bool own_links{false};               ///< and the links of the robot itself
  double standing_for{0.0};            ///< s; the same of what stands, and of own links, alone
  std::vector<models::Name> standing{};

  /// For how long it is clear of an obstacle or, if `own_link`, of the robot's own links.
  double ClearFor(models::Name obstacle, bool own_link) const {
    const auto in = [&](const std::vector<models::Name>& names) {
      return std::find(names.begin(), names.end(), obstacle) != names.end();
    };
    const double all = (own_link ? own_links : in(bodies)) ? clear_for : 0.0;
    const double alone = (own_link ? own_links : in(standing)) ? standing_for : 0.0;
    return std::max(all, alone);
  }
};

}  // namespace oca::robot
