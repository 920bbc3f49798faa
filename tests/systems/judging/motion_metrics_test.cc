// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/judging/motion_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/judging/motion_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace motion_metrics_test {

using Eigen::Vector2d;
using motion_bench::Bench;
using motion_bench::DistanceScript;
using motion_bench::Script;
using motion_bench::Scripts;
using motion_bench::Tick;
using motion_bench::VectorScript;

TEST(MotionMetricsTest, HasNoValueWithoutASource) {
  Bench bench({});
  std::string text;
  Signal<MotionMetricsValue>::WriteJson(bench.At(1.0), text);
  EXPECT_EQ(
      text,
      R"({"min_distance":null,"min_distance_pair":null,"min_distance_time":null,)"
      R"("certified_min_distance":null,"contact_time":null,"first_contact_time":null,"max_abs_delta":null,)"
      R"("final_error":null,"time_to_goal":null,"delta_sign_changes_per_second":null,)"
      R"("total_variation_ratio":null,"path_length":null,"max_joint_speed":null,"final_speed":null,)"
      R"("max_joint_acceleration":null,"limit_violations":null,)"
      R"("stuck_time":null,"stuck_amount":null,"stuck_pair":null})");
}

TEST(MotionMetricsTest, FindsTheLeastDistanceItsPairAndItsTime) {
  Bench bench({.distance = [](double t) { return 0.1 + std::fabs(t - 0.4); }});
  const MotionMetricsValue& value = bench.At(1.0);
  EXPECT_NEAR(value.min_distance.value(), 0.1, 1e-15);
  EXPECT_EQ(value.min_distance_time, 0.4);
  EXPECT_EQ(value.min_distance_link, models::Name("hand"));
  EXPECT_EQ(value.min_distance_obstacle, models::Name("box"));
  EXPECT_EQ(value.contact_time, 0.0);
  EXPECT_FALSE(value.first_contact_time.has_value());
}

TEST(MotionMetricsTest, HasNoLeastDistanceIfNothingEverCameNear) {
  Bench bench({.distance = [](double) { return std::numeric_limits<double>::infinity(); }});
  EXPECT_FALSE(bench.At(1.0).min_distance.has_value());
  EXPECT_EQ(bench.At(1.0).contact_time, 0.0);
}

// What was not looked at is not clear.
TEST(MotionMetricsTest, SaysNothingOfContactUntilAPairWasLookedAt) {
  Bench never({.distance = [](double) { return std::nan(""); }});
  EXPECT_FALSE(never.At(1.0).contact_time.has_value());
  EXPECT_FALSE(never.At(1.0).min_distance.has_value());
  const DistanceScript appears = [](double t) {
    return Tick(t) == 5 ? std::numeric_limits<double>::infinity() : std::nan("");
  };
  Bench once({.distance = appears});
  EXPECT_FALSE(once.At(0.4).contact_time.has_value());
  EXPECT_EQ(once.At(1.0).contact_time, 0.0);
}

// In contact from 0.3 s to 0.6 s; touch counts.
TEST(MotionMetricsTest, SumsTheTimeInContact) {
  const DistanceScript touch = [](double t) {
    return Tick(t) >= 3 && Tick(t) < 6 ? (Tick(t) == 4 ? 0.0 : -0.01) : 1e-9;
  };
  Bench bench({.distance = touch});
  EXPECT_NEAR(bench.At(0.3).contact_time.value(), 0.0, 1e-15);
  EXPECT_NEAR(bench.At(0.35).contact_time.value(), 0.05, 1e-15);
  const MotionMetricsValue& value = bench.At(1.0);
  EXPECT_NEAR(value.contact_time.value(), 0.3, 1e-15);
  EXPECT_NEAR(value.first_contact_time.value(), 0.3, 1e-15);
  EXPECT_EQ(value.min_distance, -0.01);
}

TEST(MotionMetricsTest, CountsTheSampleAtTheEndOnceWhoseUpdateIsPending) {
  Bench bench({.delta = [](double t) { return Vector2d(t >= 0.5 ? -2.0 : 0.0, 0.0); },
               .distance = [](double t) { return 1.0 - t; }});
  EXPECT_EQ(bench.At(0.5).max_abs_delta, 2.0);
  EXPECT_EQ(bench.At(0.5).min_distance, 0.5);
  EXPECT_EQ(bench.At(0.5).min_distance_time, 0.5);
  // One change, so no reversal, however often it is looked at.
  EXPECT_EQ(bench.At(0.5).delta_sign_changes_per_second, 0.0);
  EXPECT_EQ(bench.At(0.6).delta_sign_changes_per_second, 0.0);
}

TEST(MotionMetricsTest, LooksAtTicksOnly) {
  Bench bench({.distance = [](double t) { return t > 0.41 && t < 0.49 ? 0.0 : 1.0; }});
  EXPECT_EQ(bench.At(0.45).min_distance, 1.0);
  EXPECT_EQ(bench.At(1.0).min_distance, 1.0);
}

TEST(MotionMetricsTest, LooksAtDistancesBetweenTicksIfAskedTo) {
  const Scripts scripts{.position = [](double t) -> Vector2d {
                          return {t * t, 0.0};
                        },
                        .delta = [](double t) -> Vector2d {
                          return {std::sin(20.0 * t), 0.0};
                        },
                        .distance = [](double t) { return t > 0.41 && t < 0.49 ? 0.0 : 1.0; }};
  Bench ticks(scripts);
  Bench looks(scripts, 4);
  EXPECT_EQ(looks.At(0.43).min_distance, 0.0);
  EXPECT_EQ(looks.At(1.0).min_distance_time, 0.425);
  EXPECT_NEAR(*looks.At(1.0).contact_time, 0.075, 1e-12);
  EXPECT_EQ(ticks.At(1.0).contact_time, 0.0);
  // All else is of the ticks.
  EXPECT_EQ(looks.At(1.0).path_length, ticks.At(1.0).path_length);
  EXPECT_EQ(looks.At(1.0).max_joint_acceleration, ticks.At(1.0).max_joint_acceleration);
  EXPECT_EQ(looks.At(1.0).delta_sign_changes_per_second,
            ticks.At(1.0).delta_sign_changes_per_second);
  EXPECT_EQ(looks.At(1.0).max_abs_delta, ticks.At(1.0).max_abs_delta);
}

// Joint 1: up, up, down, up in turn gives two reversals a cycle of 4 ticks; joint 2 rests.
TEST(MotionMetricsTest, CountsReversalsOfTheChangeOfDelta) {
  const double level[] = {0.0, 1.0, 2.0, 1.0};
  Bench bench({.delta = [&](double t) { return Vector2d(level[Tick(t) % 4], 5.0); }});
  // Changes over 2 s: +1 +1 -1 -1, five times: 9 reversals, two joints.
  EXPECT_NEAR(bench.At(2.0).delta_sign_changes_per_second.value(), 9.0 / 2.0 / 2.0, 1e-12);
}

TEST(MotionMetricsTest, TakesChangesUpToAMicroradForNone) {
  for (const auto& [size, reversals] : {std::pair(0.9e-6, 0.0), std::pair(1.1e-6, 9.0)}) {
    const double step = size;
    Bench bench({.delta = [step](double t) { return Vector2d(Tick(t) % 2 * step, 0.0); }});
    EXPECT_NEAR(bench.At(1.0).delta_sign_changes_per_second.value(), reversals / 2.0, 1e-12);
  }
}

// A pause between a rise and a fall does not hide the reversal.
TEST(MotionMetricsTest, RemembersTheDirectionOverAPause) {
  Bench bench({.delta = [](double t) {
    return Vector2d(Tick(t) == 0 ? 0.0 : Tick(t) < 8 ? 1.0 : 0.0, 0.0);
  }});
  EXPECT_NEAR(bench.At(1.0).delta_sign_changes_per_second.value(), 0.5, 1e-12);
}

TEST(MotionMetricsTest, ComparesThePathWithThatOfTheRequest) {
  // The request moves both joints by 1 rad in all; the position goes there, back and there again.
  Bench bench({.position = [](double t) { return Vector2d(std::fabs(Tick(t) % 20 - 10) / 10, 0); },
               .request = [](double t) { return Vector2d(t / 6.0, t / 6.0); }});
  EXPECT_NEAR(bench.At(3.0).total_variation_ratio.value(), 3.0, 1e-12);
}

TEST(MotionMetricsTest, HasNoPathRatioForARequestAtRest) {
  Bench bench({.position = [](double t) { return Vector2d(t, 0.0); },
               .request = [](double) { return Vector2d(1.0, 1.0); }});
  EXPECT_FALSE(bench.At(1.0).total_variation_ratio.has_value());
}

TEST(MotionMetricsTest, MeasuresTheErrorAgainstTheGoalAndElseTheRequest) {
  const VectorScript position = [](double t) { return Vector2d(t, -2.0 * t); };
  const VectorScript goal = [](double) { return Vector2d(1.0, 1.0); };
  const VectorScript request = [](double) { return Vector2d::Zero(); };
  EXPECT_NEAR(
      Bench({.position = position, .request = request, .goal = goal}).At(0.25).final_error.value(),
      1.5, 1e-15);
  EXPECT_NEAR(Bench({.position = position, .request = request}).At(0.25).final_error.value(), 0.5,
              1e-15);
  EXPECT_FALSE(Bench({.position = position}).At(0.25).final_error.has_value());
}

TEST(MotionMetricsTest, FindsTheFastestAndTheHardestTick) {
  // q = t^2 on joint 2: over the last tick 1.9 rad/s, and 2 rad/s^2 at each.
  Bench bench({.position = [](double t) { return Vector2d(0.0, -t * t); }});
  EXPECT_FALSE(bench.At(0.0).max_joint_speed.has_value());
  EXPECT_FALSE(bench.At(0.1).max_joint_acceleration.has_value());
  const MotionMetricsValue& value = bench.At(1.0);
  EXPECT_NEAR(value.max_joint_speed.value(), 1.9, 1e-12);
  EXPECT_NEAR(value.max_joint_acceleration.value(), 2.0, 1e-11);
}

TEST(MotionMetricsTest, WritesEveryMetricWithNullWhereThereIsNone) {
  Bench bench({.position = [](double t) { return Vector2d(t, 0.0); },
               .delta = [](double) { return Vector2d(0.0, 0.5); },
               .distance = [](double) { return -0.5; }});
  std::string text;
  Signal<MotionMetricsValue>::WriteJson(bench.At(1.0), text);
  EXPECT_TRUE(text.starts_with(
      R"({"min_distance":-0.5,"min_distance_pair":["hand","box"],"min_distance_time":0.0,)"))
      << text;
  EXPECT_NE(text.find(R"("max_abs_delta":0.5,"final_error":null,)"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with(R"("stuck_time":null,"stuck_amount":null,"stuck_pair":null})"))
      << text;
}

TEST(MotionMetricsTest, RefusesSignalsOfUnequalUnits) {
  DiagramBuilder builder;
  const auto& metrics = builder.Add<MotionMetrics>("metrics", MotionMetrics::Params{Period(1, 10)});
  const auto& script = builder.Add<Script>("script", [](double) { return Vector2d::Zero(); });
  builder.Connect(script.value, metrics.position);
  struct Metres final : System {
    Metres() : value(DeclareOutput<Vector, &Metres::Calc>("value", {2, "m"}, kTime)) {}
    void Calc(double, MutableVectorView out) const { out.setZero(); }
    const Output<Vector> value;
  };
  builder.Connect(builder.Add<Metres>("metres").value, metrics.delta);
  EXPECT_THROW(builder.Build(), WiringError);
}

TEST(MotionMetricsTest, RefusesAPeriodOfZero) {
  EXPECT_THROW(MotionMetrics(MotionMetrics::Params{}), ConfigError);
}

}  // namespace motion_metrics_test
}  // namespace oca::systems
