// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/stoppable_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace oca::motion {
namespace {

constexpr std::array kLimitNames{"none", "position", "velocity", "acceleration", "jerk"};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Kept free before a position limit, so that the rounding of a long way to a halt has room; of the
// limit itself where that is large, for rounding is.
constexpr double kRoom = 1e-12;
// A contradiction of two bounds below this is rounding.
constexpr double kRounding = 1e-9;
constexpr int kBisections = 20;
// Of a way to a halt, 20 s at 1 kHz: what one tick may cost for a jerk limit that is next to none.
constexpr int kMostSteps = 20000;

// Above this ratio of the distance to that of one step of braking, steps do not count any more.
constexpr double kManySteps = 1e30;

double RoomBefore(double limit) { return kRoom * std::max(std::fabs(limit), 1.0); }

/// The limits that a way to a halt is planned within.
JointLimits Inner(JointLimits limits) {
  if (std::isfinite(limits.lower)) limits.lower += RoomBefore(limits.lower);
  if (std::isfinite(limits.upper)) limits.upper -= RoomBefore(limits.upper);
  return limits;
}

void LimitAbove(double bound, MotionLimit limit, VelocityRange& range) {
  if (bound >= range.upper) return;
  range.upper = bound;
  range.upper_limit = limit;
}

void LimitBelow(double bound, MotionLimit limit, VelocityRange& range) {
  if (bound <= range.lower) return;
  range.lower = bound;
  range.lower_limit = limit;
}

/// What a drive can do: the ends are finite unless acceleration and jerk are unlimited.
VelocityRange DriveRange(const JointLimits& limits, const JointMotion& motion, double dt) {
  VelocityRange range{-kInfinity, kInfinity};
  const double step = limits.acceleration * dt;
  LimitAbove(motion.velocity + step, MotionLimit::kAcceleration, range);
  LimitBelow(motion.velocity - step, MotionLimit::kAcceleration, range);
  const double change = limits.jerk * dt;
  const double upper = motion.velocity + (motion.acceleration + change) * dt;
  const double lower = motion.velocity + (motion.acceleration - change) * dt;
  // An acceleration that is too large comes down by the jerk.
  if (upper < range.lower) return {upper, upper, MotionLimit::kJerk, MotionLimit::kJerk};
  if (lower > range.upper) return {lower, lower, MotionLimit::kJerk, MotionLimit::kJerk};
  LimitAbove(upper, MotionLimit::kJerk, range);
  LimitBelow(lower, MotionLimit::kJerk, range);
  return range;
}

/// Without a jerk limit: the exact set.
VelocityRange WithoutJerk(const JointLimits& limits, const JointMotion& motion, double dt) {
  const VelocityRange drive = DriveRange(limits, motion, dt);
  VelocityRange range{-limits.velocity, limits.velocity, MotionLimit::kVelocity,
                      MotionLimit::kVelocity};
  const double a = limits.acceleration;
  const JointLimits inner = Inner(limits);
  LimitAbove(LargestStoppableVelocity(inner.upper - motion.position, a, dt), MotionLimit::kPosition,
             range);
  LimitBelow(-LargestStoppableVelocity(motion.position - inner.lower, a, dt),
             MotionLimit::kPosition, range);
  if (drive.lower > range.upper) {
    const MotionLimit yields =
        drive.lower > range.upper + kRounding ? range.upper_limit : MotionLimit::kNone;
    return {drive.lower, drive.lower, MotionLimit::kAcceleration, MotionLimit::kAcceleration,
            yields};
  }
  if (drive.upper < range.lower) {
    const MotionLimit yields =
        drive.upper < range.lower - kRounding ? range.lower_limit : MotionLimit::kNone;
    return {drive.upper, drive.upper, MotionLimit::kAcceleration, MotionLimit::kAcceleration,
            yields};
  }
  LimitAbove(drive.upper, drive.upper_limit, range);
  LimitBelow(drive.lower, drive.lower_limit, range);
  return range;
}

/// The limit that `motion` breaks by more than rounding.
MotionLimit Broken(const JointLimits& limits, const JointMotion& motion) {
  if (std::fabs(motion.velocity) > limits.velocity + kRounding) return MotionLimit::kVelocity;
  if (motion.position > limits.upper || motion.position < limits.lower) {
    return MotionLimit::kPosition;
  }
  return MotionLimit::kNone;
}

/// A bound on how far and how fast the way to a halt can lead: true if it surely keeps the limits.
bool SurelyStops(const JointLimits& limits, const JointMotion& motion, double dt) {
  if (!std::isfinite(limits.acceleration) || !std::isfinite(limits.jerk)) return false;
  const double a = std::fabs(motion.acceleration);
  const double v = std::fabs(motion.velocity) + a * (0.5 * a / limits.jerk + 2.0 * dt);
  const double ramp = (a + limits.acceleration) / limits.jerk + 4.0 * dt;
  const double distance = v * (ramp + v / limits.acceleration);
  return v < limits.velocity && motion.position + distance < limits.upper &&
         motion.position - distance > limits.lower;
}

bool AtRest(const JointMotion& motion) {
  return std::fabs(motion.velocity) < kRoom && std::fabs(motion.acceleration) < kRounding;
}

/// The first limit that is broken at `motion` or on the way from there to a halt.
MotionLimit BrokenOnTheWay(const JointLimits& limits, JointMotion motion, double dt) {
  if (SurelyStops(limits, motion, dt)) return MotionLimit::kNone;
  for (int step = 0; step < kMostSteps; ++step) {
    const MotionLimit broken = Broken(limits, motion);
    if (broken != MotionLimit::kNone) return broken;
    if (AtRest(motion)) break;
    motion = Advance(motion, StopStep(limits, motion, dt), dt);
  }
  return MotionLimit::kNone;
}

/// How far and how fast the way to a halt leads from `motion`.
struct Way {
  double lowest;
  double highest;
  double fastest;
};

Way WayToHalt(const JointLimits& limits, JointMotion motion, double dt) {
  Way way{motion.position, motion.position, std::fabs(motion.velocity)};
  for (int step = 0; step < kMostSteps && !AtRest(motion); ++step) {
    motion = Advance(motion, StopStep(limits, motion, dt), dt);
    way.lowest = std::min(way.lowest, motion.position);
    way.highest = std::max(way.highest, motion.position);
    way.fastest = std::max(way.fastest, std::fabs(motion.velocity));
  }
  return way;
}

struct End {
  double velocity;
  MotionLimit limit;
};

/// The velocity nearest to `end` from which the way to a halt keeps the limits; `stop` does.
End Reach(const JointLimits& limits, const JointMotion& motion, double dt, double stop, End end) {
  MotionLimit broken = BrokenOnTheWay(limits, Advance(motion, end.velocity, dt), dt);
  if (broken == MotionLimit::kNone) return end;
  double good = stop;
  double bad = end.velocity;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (good + bad);
    const MotionLimit now = BrokenOnTheWay(limits, Advance(motion, middle, dt), dt);
    (now == MotionLimit::kNone ? good : bad) = middle;
    if (now != MotionLimit::kNone) broken = now;
  }
  return {good, broken};
}

}  // namespace

const char* NameOf(MotionLimit limit) { return kLimitNames[static_cast<std::size_t>(limit)]; }

double LargestStoppableVelocity(double distance, double acceleration, double dt) {
  const double step = acceleration * dt;
  if (!(distance > 0.0)) return 0.0;
  if (std::isinf(distance) || std::isinf(step)) return distance / dt;
  const double steps = distance / (step * dt);
  if (steps > kManySteps) return std::sqrt(2.0 * acceleration) * std::sqrt(distance);
  const double m = std::floor(0.5 * (std::sqrt(1.0 + 8.0 * steps) - 1.0));
  return (distance / dt + 0.5 * step * m * (m + 1.0)) / (m + 1.0);
}

JointMotion Advance(const JointMotion& motion, double velocity, double dt) {
  return {motion.position + velocity * dt, velocity, (velocity - motion.velocity) / dt};
}

double StopStep(const JointLimits& limits, const JointMotion& motion, double dt) {
  // In terms of a motion forwards; the same mirrored for one backwards.
  const double sign = motion.velocity >= 0.0 ? 1.0 : -1.0;
  const double v = sign * motion.velocity;
  const double a = sign * motion.acceleration;
  const double hardest = std::min(LargestStoppableVelocity(v, limits.jerk, dt), v / dt);
  double next = -std::min(hardest, limits.acceleration);
  const double change = limits.jerk * dt;
  next = std::min(std::max(next, a - change), a + change);
  return sign * (v + next * dt);
}

VelocityRange StoppableVelocities(const JointLimits& limits, const JointMotion& motion, double dt) {
  if (!std::isfinite(limits.jerk)) return WithoutJerk(limits, motion, dt);
  JointLimits inner = Inner(limits);
  const VelocityRange drive = DriveRange(limits, motion, dt);
  const double stop = std::clamp(StopStep(limits, motion, dt), drive.lower, drive.upper);
  const JointMotion stopping = Advance(motion, stop, dt);
  MotionLimit yields = MotionLimit::kNone;
  if (!SurelyStops(inner, stopping, dt)) {
    // What is beyond a limit, or cannot but get there, counts only for what goes farther.
    const Way way = WayToHalt(limits, stopping, dt);
    if (way.fastest > limits.velocity + kRounding) yields = MotionLimit::kVelocity;
    if (way.highest > std::max(limits.upper, motion.position) ||
        way.lowest < std::min(limits.lower, motion.position)) {
      yields = MotionLimit::kPosition;
    }
    inner.lower = std::min({inner.lower, motion.position, way.lowest});
    inner.upper = std::max({inner.upper, motion.position, way.highest});
    inner.velocity = std::max(inner.velocity, way.fastest - kRounding);  // which Broken allows
  }
  const End lower = Reach(inner, motion, dt, stop, {drive.lower, drive.lower_limit});
  const End upper = Reach(inner, motion, dt, stop, {drive.upper, drive.upper_limit});
  return {lower.velocity, upper.velocity, lower.limit, upper.limit, yields};
}

}  // namespace oca::motion
