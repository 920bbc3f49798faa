// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/following.h"

#include <algorithm>
#include <cmath>

#include "oca/models/motion/stoppable_motion.h"

namespace oca::motion {
namespace {

// Share of the acceleration limit that the return to the request brakes with.
constexpr double kArrivalShare = 0.5;

}  // namespace

double FollowingVelocity(const JointRequest& request, double position, double gain,
                         double acceleration_limit, double dt) {
  const double away = request.position - position;
  const double fastest =
      LargestStoppableVelocity(std::fabs(away), kArrivalShare * acceleration_limit, dt);
  return std::copysign(std::min(gain * std::fabs(away), fastest), away) + request.velocity +
         0.5 * dt * request.acceleration;
}

}  // namespace oca::motion
