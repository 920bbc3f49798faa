// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::motion {

/// What a joint is asked for at a tick. Units are those of the joint, rad or m, and their rates.
struct JointRequest {
  double position;
  double velocity;
  double acceleration;
};

/// The velocity, constant over the next period dt (s), with which a joint at `position` follows its
/// request:
///
///     velocity + acceleration dt / 2 + gain (request.position - position)
///
/// where the last term is at most what half of `acceleration_limit` stops at the request, so that
/// the joint arrives without passing it. `gain` is in 1/s.
double FollowingVelocity(const JointRequest& request, double position, double gain,
                         double acceleration_limit, double dt);

}  // namespace oca::motion
