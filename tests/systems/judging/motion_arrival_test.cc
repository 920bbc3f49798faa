// SPDX-License-Identifier: BSD-3-Clause
// Whether MotionMetrics sees an arm arrive, or stuck.
#include <gtest/gtest.h>

#include "tests/systems/judging/motion_bench.h"

namespace oca::systems {
namespace motion_arrival_test {

using Eigen::Vector2d;
using motion_bench::Bench;
using motion_bench::DistanceScript;
using motion_bench::Scripts;
using motion_bench::Tick;
using motion_bench::VectorScript;

TEST(MotionArrivalTest, TellsWhenTheGoalWasReachedForGood) {
  // Near the goal from 0.2 s, away at 0.5 s, near again from 0.6 s to 0.9 s.
  const VectorScript position = [](double t) {
    const bool away = Tick(t) < 2 || Tick(t) == 5 || Tick(t) == 10;
    return Vector2d(1.0, away ? 0.9899 : 0.9901);
  };
  const VectorScript goal = [](double) { return Vector2d(1.0, 1.0); };
  Bench bench({.position = position, .goal = goal});
  EXPECT_FALSE(bench.At(0.1).time_to_goal.has_value());
  EXPECT_NEAR(bench.At(0.4).time_to_goal.value(), 0.2, 1e-12);
  EXPECT_FALSE(bench.At(0.5).time_to_goal.has_value());
  EXPECT_NEAR(bench.At(0.9).time_to_goal.value(), 0.6, 1e-12);
  EXPECT_FALSE(bench.At(1.0).time_to_goal.has_value());
  EXPECT_FALSE(Bench({.position = position, .request = goal}).At(0.9).time_to_goal.has_value());
}

// Before the goal, off the request, from 1 s to `end`; a joint creeps by less than counts.
Scripts StandsUntil(double end) {
  const auto position = [end](double t) {
    return Vector2d(t > 0.95 && t < end - 0.05 ? 0.4 + 0.004 * (t - 1.0) : 0.4 * t, 0.0);
  };
  return {.position = position,
          .request = [](double t) { return Vector2d(0.5 * t, 0.0); },
          .goal = [](double) { return Vector2d(10.0, 0.0); },
          .distance = [](double) { return 0.03; }};
}

TEST(MotionArrivalTest, TellsHowLongTheArmWasStuckAndAtWhat) {
  Bench bench(StandsUntil(4.0));
  EXPECT_EQ(bench.At(2.9).stuck_time, 0.0);
  EXPECT_TRUE(bench.At(2.9).stuck_link.empty());
  EXPECT_FALSE(bench.At(2.9).stuck_amount.has_value());
  EXPECT_NEAR(bench.At(3.0).stuck_time.value(), 2.0, 1e-9);
  const MotionMetricsValue value = bench.At(5.0);
  EXPECT_NEAR(value.stuck_time.value(), 2.9, 1e-9);
  EXPECT_EQ(value.stuck_link, models::Name("hand"));
  EXPECT_EQ(value.stuck_obstacle, models::Name("box"));
  EXPECT_EQ(value.stuck_amount, 0.03);
  std::string text;
  Signal<MotionMetricsValue>::WriteJson(value, text);
  EXPECT_NE(text.find(R"("stuck_pair":["hand","box"])"), std::string::npos) << text;
}

TEST(MotionArrivalTest, IsNotStuckWhereItStandsAsRequestedOrForAShortTime) {
  EXPECT_EQ(Bench(StandsUntil(2.9)).At(5.0).stuck_time, 0.0);
  Scripts waits = StandsUntil(4.0);
  waits.request = waits.position;
  EXPECT_EQ(Bench(waits).At(5.0).stuck_time, 0.0);
  Scripts arrived = StandsUntil(4.0);
  arrived.goal = arrived.position;
  EXPECT_EQ(Bench(arrived).At(5.0).stuck_time, 0.0);
  Scripts alone = StandsUntil(4.0);
  alone.distance = {};
  EXPECT_TRUE(Bench(alone).At(3.5).stuck_link.empty());
  EXPECT_GT(Bench(alone).At(3.5).stuck_time.value(), 2.0);
}

TEST(MotionArrivalTest, IsStuckWhereItGoesAboutAndComesNoNearer) {
  const VectorScript goal = [](double) { return Vector2d(1.0, 0.0); };
  const auto about = [&](double gain) {
    Bench bench({.position =
                     [gain](double t) {
                       return Vector2d(gain * t, std::sin(5.0 * t));  // within 1 of its goal
                     },
                 .request = goal,
                 .goal = goal,
                 .distance = [](double) { return 0.03; }});
    return bench.At(6.0);
  };
  // Every 0.1 s off by more than 0.02, so it never stands; the largest distance stays 1 or so.
  const MotionMetricsValue stuck = about(0.0);
  EXPECT_GT(stuck.stuck_time.value(), 4.0);
  EXPECT_EQ(stuck.stuck_obstacle, models::Name("box"));
  // A request that still goes on asks for no gain.
  Bench asked({.position = [](double t) { return Vector2d(0.0, std::sin(5.0 * t)); },
               .request = [](double t) { return Vector2d(0.1 * t, 0.0); },
               .goal = goal,
               .distance = [](double) { return 0.03; }});
  EXPECT_EQ(asked.At(6.0).stuck_time, 0.0);
}

}  // namespace motion_arrival_test
}  // namespace oca::systems
