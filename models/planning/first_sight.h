// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "oca/models/name.h"
#include "oca/models/planning/clairvoyant.h"
#include "oca/models/robot/robot_model.h"

namespace oca::planning {

/// What can be said of a task by the time at which it is first seen that something moves.
struct FirstSight {
  std::optional<double> time{};  ///< s; none if nothing moves
  /// Nobody who followed the request up to then can evade: proven. False: not known.
  bool too_late{false};
  double contact{0.0};  ///< s; where that is proven
  double depth{0.0};    ///< m; of the request in `body` then
  double reach{0.0};    ///< m; that no point of `link` can be farther from its place in the request
  models::Name link{};
  models::Name body{};
};

/// Whether nobody could have evaded who knows what moves from the time on at which it is first seen
/// to, a proof in one direction. At a time t after first sight joint j is within
///
///     d_j(t) = largest |q_j - request_j(t)| that its limits of speed and acceleration allow
///
/// of the request, so no point of a link is farther from its place there than robot::TravelBound of
/// the paths d_j. A convex solid whose points all move by less than the depth by which it overlaps
/// another one still overlaps it: the width of their Minkowski difference stays positive in every
/// direction. So the arm touches if that bound is below the depth of the request.
FirstSight LookAtFirstSight(const std::shared_ptr<const robot::RobotModel>& model,
                            const ClairvoyantTask& task);

}  // namespace oca::planning
