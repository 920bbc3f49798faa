// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::motion {

// One joint that is commanded a constant velocity over each period dt (s), so that its position
// moves in straight lines between ticks. Units are those of the joint, rad or m, and their rates.

enum class MotionLimit { kNone, kPosition, kVelocity, kAcceleration, kJerk };
/// "none", "position", ...
const char* NameOf(MotionLimit limit);

/// The last four may be infinite. The change of velocity from one period to the next is at most
/// acceleration * dt, that of this change, jerk * dt^2.
struct JointLimits {
  double lower;
  double upper;
  double velocity;
  double acceleration;
  double jerk;
};

/// Position at a tick; velocity of the period that ends there; its change from the one before,
/// divided by dt.
struct JointMotion {
  double position{0.0};
  double velocity{0.0};
  double acceleration{0.0};
};

/// The velocities that a joint may have in the next period, and which limit each end comes from.
/// If no velocity keeps all limits, `yields` names what cannot be kept, and the range is what
/// breaks it least: without a jerk limit a single velocity.
struct VelocityRange {
  double lower;
  double upper;
  MotionLimit lower_limit{MotionLimit::kNone};
  MotionLimit upper_limit{MotionLimit::kNone};
  MotionLimit yields{MotionLimit::kNone};
};

/// The largest velocity u of the next period after which a joint that then brakes stands within
/// `distance`, which is the u where
///
///     dt (u + max(u - a dt, 0) + max(u - 2 a dt, 0) + ...) = distance.
///
/// With k dt^2 a the last sum of 1, 3, 6, ... below the distance, m terms of it brake:
///
///     u = (distance / dt + a dt m (m + 1) / 2) / (m + 1),
///     m = floor((sqrt(1 + 8 distance / (a dt^2)) - 1) / 2).
///
/// The usual -a dt/2 + sqrt((a dt/2)^2 + 2 a distance) agrees at whole m only, and between them
/// overshoots the distance by up to a dt^2 / 8; the continuous sqrt(2 a distance) always does.
double LargestStoppableVelocity(double distance, double acceleration, double dt);

/// All limits at once, from a motion from which it is possible to stop (or else the nearest to it):
/// with any velocity of the range it is possible again, for ever. Without a jerk limit the range is
/// the whole set of these; with one it is that part of it from which a fixed way to stop,
/// StopStep, keeps all limits. Velocity and position limits yield to acceleration and jerk, which
/// bound what a drive can do at all.
///
/// A joint that stands beyond a position limit, or moves there, is let back in: the limit counts
/// only for what leads farther out than the joint is, or than it cannot but get. A velocity beyond
/// its limit comes down.
VelocityRange StoppableVelocities(const JointLimits& limits, const JointMotion& motion, double dt);

/// The motion one period later with `velocity`.
JointMotion Advance(const JointMotion& motion, double velocity, double dt);

/// The velocity of the next period on the way to a halt: the hardest braking from which the
/// acceleration can be led back to zero, by no more than the jerk, before the joint turns round.
double StopStep(const JointLimits& limits, const JointMotion& motion, double dt);

}  // namespace oca::motion
