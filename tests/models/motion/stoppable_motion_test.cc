// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/stoppable_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace oca::motion {
namespace stoppable_motion_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDt = 0.01;

/// How far a joint gets that moves with u for a period and then brakes.
double StoppingDistance(double u, double acceleration, double dt) {
  double distance = 0.0;
  for (; u > 0.0; u -= acceleration * dt) distance += u * dt;
  return distance;
}

TEST(StoppableMotionTest, StopsWithinTheDistanceToTheLastBit) {
  // 1, 3 and 6 steps of a dt^2 are stops from a dt, 2 a dt and 3 a dt.
  EXPECT_DOUBLE_EQ(LargestStoppableVelocity(1e-3, 10, kDt), 0.1);
  EXPECT_DOUBLE_EQ(LargestStoppableVelocity(3e-3, 10, kDt), 0.2);
  EXPECT_DOUBLE_EQ(LargestStoppableVelocity(6e-3, 10, kDt), 0.3);
  EXPECT_DOUBLE_EQ(LargestStoppableVelocity(4.5e-3, 10, kDt), 0.25);
  EXPECT_EQ(LargestStoppableVelocity(0, 10, kDt), 0.0);
  for (double distance = 1e-6; distance < 3.0; distance *= 1.3) {
    const double u = LargestStoppableVelocity(distance, 7.0, kDt);
    EXPECT_NEAR(StoppingDistance(u, 7.0, kDt), distance, 1e-12 + 1e-12 * distance);
  }
}

TEST(StoppableMotionTest, TheFamiliarFormulaOvershootsWhereThisOneDoesNot) {
  const double distance = 4.5e-3;
  const double a = 10.0;
  const double familiar = -a * kDt / 2 + std::sqrt(a * kDt * a * kDt / 4 + 2 * a * distance);
  EXPECT_NEAR(StoppingDistance(familiar, a, kDt) - distance, a * kDt * kDt / 8, 2e-5);
  EXPECT_GT(StoppingDistance(std::sqrt(2 * a * distance), a, kDt), distance + 1e-3);
}

TEST(StoppableMotionTest, WithoutAnAccelerationLimitThePeriodAloneCounts) {
  EXPECT_DOUBLE_EQ(LargestStoppableVelocity(0.3, kInfinity, kDt), 30.0);
  EXPECT_EQ(LargestStoppableVelocity(kInfinity, 10.0, kDt), kInfinity);
}

TEST(StoppableMotionTest, NamesTheLimitOfEachEnd) {
  const JointLimits limits{-2, 2, 1.5, 10, kInfinity};
  VelocityRange range = StoppableVelocities(limits, {0, 0, 0}, kDt);
  EXPECT_DOUBLE_EQ(range.upper, 0.1);
  EXPECT_EQ(range.upper_limit, MotionLimit::kAcceleration);
  range = StoppableVelocities(limits, {0, 1.45, 0}, kDt);
  EXPECT_EQ(range.upper, 1.5);
  EXPECT_EQ(range.upper_limit, MotionLimit::kVelocity);
  EXPECT_EQ(range.lower_limit, MotionLimit::kAcceleration);
  range = StoppableVelocities(limits, {2.0 - 3e-3, 0.2, 0}, kDt);
  EXPECT_NEAR(range.upper, 0.2, 1e-9);
  EXPECT_EQ(range.upper_limit, MotionLimit::kPosition);
  EXPECT_EQ(range.yields, MotionLimit::kNone);
}

TEST(StoppableMotionTest, AccelerationIsTheLastToYield) {
  const JointLimits limits{-2, 2, 1.5, 10, kInfinity};
  VelocityRange range = StoppableVelocities(limits, {2.0 - 1e-3, 1.0, 0}, kDt);  // cannot stop
  EXPECT_EQ(range.lower, 0.9);
  EXPECT_EQ(range.upper, 0.9);
  EXPECT_EQ(range.yields, MotionLimit::kPosition);
  range = StoppableVelocities(limits, {0, -2.0, 0}, kDt);
  EXPECT_EQ(range.upper, -1.9);
  EXPECT_EQ(range.yields, MotionLimit::kVelocity);
  range = StoppableVelocities(limits, {2.5, 0, 0}, kDt);  // outside: it may only go back
  EXPECT_EQ(range.upper, 0.0);
  EXPECT_DOUBLE_EQ(range.lower, -0.1);
}

TEST(StoppableMotionTest, StopsALineWithJerkInTheMirrorImageToo) {
  const JointLimits limits{-2, 2, 1.5, 10, 500};
  for (const double v : {1.0, 0.3, 0.01}) {
    JointMotion motion{0, v, 3.0};
    JointMotion mirrored{0, -v, -3.0};
    int steps = 0;
    for (; steps < 100 && std::fabs(motion.velocity) + std::fabs(motion.acceleration) > 1e-9;
         ++steps) {
      const JointMotion next = Advance(motion, StopStep(limits, motion, kDt), kDt);
      mirrored = Advance(mirrored, StopStep(limits, mirrored, kDt), kDt);
      EXPECT_LE(std::fabs(next.acceleration - motion.acceleration), 5.0 + 1e-9);
      EXPECT_LE(std::fabs(next.acceleration), 10.0 + 1e-9);
      EXPECT_NEAR(next.position, -mirrored.position, 1e-12);
      motion = next;
    }
    EXPECT_LT(steps, 25) << v;
  }
}

/// Over `ticks`, every velocity that an adversary picks from the range keeps all limits.
void ExpectNoViolation(const JointLimits& limits, double dt, int ticks, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> wish(-3.0, 3.0);
  JointMotion motion;
  double target = 0.0;
  for (int k = 0; k < ticks; ++k) {
    const VelocityRange range = StoppableVelocities(limits, motion, dt);
    ASSERT_LE(range.lower, range.upper);
    ASSERT_EQ(range.yields, MotionLimit::kNone) << k;
    // Bursts to either end, random velocities, and a halt now and then.
    if (random() % 50 == 0) target = random() % 4 == 0 ? wish(random) : (random() % 2 ? 9.0 : -9.0);
    const double wanted = random() % 10 == 0 ? wish(random) : target;
    const double u = std::min(std::max(wanted, range.lower), range.upper);
    const JointMotion next = Advance(motion, u, dt);
    ASSERT_LE(next.position, limits.upper) << k;
    ASSERT_GE(next.position, limits.lower) << k;
    ASSERT_LE(std::fabs(u), limits.velocity * (1 + 1e-9)) << k;
    ASSERT_LE(std::fabs(next.acceleration), limits.acceleration * (1 + 1e-9)) << k;
    ASSERT_LE(std::fabs(next.acceleration - motion.acceleration), limits.jerk * dt * (1 + 1e-9))
        << k;
    motion = next;
  }
}

TEST(StoppableMotionTest, NoAdversaryBreaksALimitWithoutJerk) {
  ExpectNoViolation({-0.5, 1.0, 1.9, 10, kInfinity}, kDt, 500000, 1);
  ExpectNoViolation({-0.5, 1.0, 1.9, 200, kInfinity}, kDt, 100000, 2);
  ExpectNoViolation({-0.5, 1.0, 1.9, 10, kInfinity}, 1e-3, 200000, 3);
  ExpectNoViolation({-0.5, 1.0, 1.9, kInfinity, kInfinity}, kDt, 100000, 4);
}

TEST(StoppableMotionTest, NoAdversaryBreaksALimitWithJerk) {
  ExpectNoViolation({-0.5, 1.0, 1.9, 10, 500}, kDt, 100000, 5);
  ExpectNoViolation({-0.5, 1.0, 1.9, 10, 77}, kDt, 50000, 6);
  ExpectNoViolation({-0.5, 1.0, 1.9, 10, 500}, 1e-3, 20000, 7);
  ExpectNoViolation({-3.0, 3.0, 1.0, 40, 100}, kDt, 50000, 8);
}

TEST(StoppableMotionTest, ReachesTheLimitsThatItKeeps) {
  const JointLimits limits{-0.5, 1.0, 1.9, 10, 500};
  for (const double jerk : {kInfinity, 500.0}) {
    JointLimits own = limits;
    own.jerk = jerk;
    JointMotion motion;
    double fastest = 0.0;
    for (int k = 0; k < 300; ++k) {
      motion = Advance(motion, StoppableVelocities(own, motion, kDt).upper, kDt);
      fastest = std::max(fastest, motion.velocity);
    }
    EXPECT_NEAR(motion.position, 1.0, 1e-4) << jerk;
    EXPECT_GT(fastest, 1.9 * 0.99) << jerk;
  }
}

TEST(StoppableMotionTest, SaysZeroOrRootWhereStepsCannotBeCounted) {
  EXPECT_EQ(LargestStoppableVelocity(-0.1, 10, kDt), 0.0);
  EXPECT_NEAR(LargestStoppableVelocity(1e308, 2, kDt) / 2e154, 1.0, 1e-12);
}

// A closed gripper that is to open; and the same a little inside, and beyond.
TEST(StoppableMotionTest, LetsAJointAtItsLimitGo) {
  for (const double start : {0.0, 1e-13, 1e-12, -1e-13, -1e-3, -10.0}) {
    const JointLimits limits{0.0, 0.05, 0.2, 2.0, 40.0};
    JointMotion motion{start, 0.0, 0.0};
    VelocityRange range = StoppableVelocities(limits, motion, kDt);
    EXPECT_DOUBLE_EQ(range.upper, 40.0 * kDt * kDt) << start;  // as far as the jerk allows
    EXPECT_LE(range.lower, 0.0);
    if (start < 1e-12) {
      EXPECT_EQ(range.lower, 0.0) << start;
    }
    EXPECT_EQ(range.yields, MotionLimit::kNone) << start;
    for (int k = 0; k < 6000 && motion.position < 0.04; ++k) {
      motion = Advance(motion, StoppableVelocities(limits, motion, kDt).upper, kDt);
    }
    EXPECT_GE(motion.position, 0.04) << start;
  }
}

TEST(StoppableMotionTest, StaysWhereALimitLeavesNoRoom) {
  for (const double jerk : {40.0, kInfinity}) {
    const VelocityRange range = StoppableVelocities({0.1, 0.1, 1, 2, jerk}, {0.1, 0, 0}, kDt);
    EXPECT_EQ(range.lower, 0.0) << jerk;
    EXPECT_EQ(range.upper, 0.0) << jerk;
  }
}

/// Where a joint may stand at the start: about its limits, if it has any.
double StartNear(const JointLimits& limits, std::mt19937& random) {
  const auto unit = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  constexpr double kOff[] = {0.0, 1e-13, -1e-13, 1e-12, 1e-9, -1e-9, 1e-3, -1e-3, 0.3, -3.0, 50.0};
  const double off = kOff[random() % std::size(kOff)];
  const bool at_upper = random() % 2 == 0;
  const double limit = at_upper ? limits.upper : limits.lower;
  if (!std::isfinite(limit)) return 4.0 * unit() - 2.0;
  return at_upper ? limit + off : limit - off;
}

/// How far beyond its limits a position is.
double Beyond(const JointLimits& limits, double position) {
  return std::max({position - limits.upper, limits.lower - position, 0.0});
}

/// The farthest beyond, and the fastest, on the way to a halt.
std::pair<double, double> Unavoidable(const JointLimits& limits, JointMotion motion) {
  double beyond = Beyond(limits, motion.position);
  double fastest = 0.0;
  for (int k = 0; k < 5000 && (k == 0 || motion.velocity != 0.0); ++k) {
    double next = StopStep(limits, motion, kDt);
    if (!std::isfinite(limits.jerk)) {
      const double brake = std::min(limits.acceleration * kDt, std::fabs(motion.velocity));
      next = motion.velocity - std::copysign(brake, motion.velocity);
    }
    motion = Advance(motion, next, kDt);
    beyond = std::max(beyond, Beyond(limits, motion.position));
    fastest = std::max(fastest, std::fabs(motion.velocity));
  }
  return {beyond, fastest};
}

TEST(StoppableMotionTest, BrokenLimitsNeverGetWorseAndAreKeptFromThenOn) {
  std::mt19937 random(11);
  const auto uniform = [&](double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
  };
  for (int run = 0; run < 100'000; ++run) {
    JointLimits limits{uniform(-2, 0), 0.0, uniform(0.1, 2), uniform(1, 20), uniform(20, 2000)};
    limits.upper = limits.lower + (random() % 8 == 0 ? 0.0 : uniform(0, 3));
    if (random() % 4 == 0) limits.lower = -kInfinity;
    if (random() % 4 == 0) limits.upper = kInfinity;
    if (random() % 3 == 0) limits.jerk = kInfinity;
    JointMotion motion{StartNear(limits, random), 0.0, 0.0};
    if (random() % 3 == 0) motion.velocity = uniform(-3, 3);
    const double target = random() % 2 == 0 ? 9.0 : -9.0;
    for (int k = 0; k < 40; ++k) {
      const auto [beyond, fastest] = Unavoidable(limits, motion);
      const VelocityRange range = StoppableVelocities(limits, motion, kDt);
      ASSERT_LE(range.lower, range.upper);
      const double wish = random() % 5 == 0 ? uniform(-3, 3) : target;
      const double u = std::min(std::max(wish, range.lower), range.upper);
      const JointMotion next = Advance(motion, u, kDt);
      ASSERT_LE(Beyond(limits, next.position), beyond + 1e-13) << run << ' ' << k;
      ASSERT_LE(std::fabs(u), std::max(limits.velocity, fastest) + 2e-9) << run << ' ' << k;
      ASSERT_LE(std::fabs(next.acceleration), limits.acceleration * (1 + 1e-9)) << run << ' ' << k;
      if (std::isfinite(limits.jerk)) {
        ASSERT_LE(std::fabs(next.acceleration - motion.acceleration),
                  limits.jerk * kDt * (1 + 1e-9) + 1e-9)
            << run << ' ' << k;
      }
      motion = next;
    }
  }
}

// Whatever is wished for, a joint that may come back does so when it is wished.
TEST(StoppableMotionTest, ComesBackFromAnywhere) {
  std::mt19937 random(12);
  for (int run = 0; run < 2000; ++run) {
    JointLimits limits{-0.5, 1.0, 1.5, 10, random() % 2 == 0 ? 500.0 : kInfinity};
    if (random() % 4 == 0) limits.lower = -kInfinity;
    if (random() % 4 == 0) limits.upper = kInfinity;
    JointMotion motion{StartNear(limits, random), 0.0, 0.0};
    motion.velocity = std::uniform_real_distribution<double>(-3, 3)(random);
    for (int k = 0; k < 6000 && std::fabs(motion.position - 0.2) > 0.05; ++k) {
      const VelocityRange range = StoppableVelocities(limits, motion, kDt);
      const double wish = 2.0 * (0.2 - motion.position);
      motion = Advance(motion, std::min(std::max(wish, range.lower), range.upper), kDt);
    }
    EXPECT_NEAR(motion.position, 0.2, 0.05) << run;
  }
}

}  // namespace stoppable_motion_test
}  // namespace oca::motion
