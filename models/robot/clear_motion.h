// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "oca/models/name.h"

namespace oca::robot {

/// How long a planned motion is known to be clear, and of what: not of anything else.
struct ClearMotion {
  double clear_for{0.0};               ///< s; from now on, 0: not known to be
  std::vector<models::Name> bodies{};  ///< obstacles that it was planned with
  bool own_links{false};               ///< and the links of the robot itself

  /// Whether it was planned with an obstacle or, if `own_link`, with the robot's own links.
  bool Knows(models::Name obstacle, bool own_link) const {
    return own_link ? own_links : std::find(bodies.begin(), bodies.end(), obstacle) != bodies.end();
  }
};

}  // namespace oca::robot
