// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/delta_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/fields/delta_limiter.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace delta_relaxation_test {

DeltaRelaxation::Params Relax(double relaxation_time) {
  return {.relaxation_time = relaxation_time, .period = Period(1, 100)};
}

TEST(DeltaRelaxationTest, GoesATenthOfTheWayEachTick) {
  SystemBench<DeltaRelaxation> bench(Relax(0.1));
  bench->delta.Fix(bench.context(), Eigen::VectorXd::Constant(1, -2.0));
  double rest = 0.9;  // of the way, after the tick whose value the output shows
  for (int tick = 0; tick < 5; ++tick, rest *= 0.9) {
    EXPECT_NEAR(bench->relaxed_delta.Eval(bench.context())[0], -2.0 * (1.0 - rest), 1e-15) << tick;
    bench.AdvanceTo((tick + 1) * 0.01);
  }
}

TEST(DeltaRelaxationTest, ATimeOfZeroPassesTheDeltaBitByBit) {
  SystemBench<DeltaRelaxation> bench(Relax(0.0));
  bench->delta.Fix(bench.context(), Eigen::VectorXd::Constant(1, 1e17));
  bench.AdvanceTo(0.01);
  bench->delta.Fix(bench.context(), Eigen::VectorXd::Constant(1, 0.1));
  EXPECT_EQ(bench->relaxed_delta.Eval(bench.context())[0], 0.1);
}

TEST(DeltaRelaxationTest, ATimeOfOnePeriodIsTheLastThatPassesTheDelta) {
  SystemBench<DeltaRelaxation> one(Relax(0.01)), more(Relax(0.0100001));
  one->delta.Fix(one.context(), Eigen::VectorXd::Constant(1, 0.7));
  more->delta.Fix(more.context(), Eigen::VectorXd::Constant(1, 0.7));
  EXPECT_EQ(one->relaxed_delta.Eval(one.context())[0], 0.7);
  EXPECT_LT(more->relaxed_delta.Eval(more.context())[0], 0.7);
}

TEST(DeltaRelaxationTest, CostsTheLimiterBehindItNoTick) {
  DiagramBuilder builder;
  const auto& relaxation = builder.Add<DeltaRelaxation>("relaxation", Relax(0.1));
  const auto& limiter = builder.Add<DeltaLimiter>(
      "limiter", DeltaLimiter::Params{.max_joint_velocity = 100.0, .period = Period(1, 100)});
  builder.Connect(relaxation.relaxed_delta, limiter.delta);
  builder.ExportInput("delta", relaxation.delta);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  relaxation.delta.Fix(simulator.context(), Eigen::VectorXd::Constant(1, 1.0));
  simulator.AdvanceTo(0.01);
  EXPECT_NEAR(limiter.limited_delta.Eval(simulator.context())[0], 0.1, 1e-15);
  simulator.AdvanceTo(0.02);
  EXPECT_NEAR(limiter.limited_delta.Eval(simulator.context())[0], 0.19, 1e-15);
}

TEST(DeltaRelaxationTest, TheLongerOfBothTimesCounts) {
  for (const double told : {0.05, 0.2}) {
    DiagramBuilder builder;
    const auto& time = builder.Add<Constant>("time", Constant::Params{told, "s"});
    const auto& relaxation = builder.Add<DeltaRelaxation>("relaxation", Relax(0.1));
    builder.Connect(time.value, relaxation.relaxation_time);
    builder.ExportInput("delta", relaxation.delta, 1);
    const auto diagram = builder.Build();
    Simulator simulator(*diagram);
    relaxation.delta.Fix(simulator.context(), Eigen::VectorXd::Constant(1, 1.0));
    EXPECT_NEAR(relaxation.relaxed_delta.Eval(simulator.context())[0], 0.01 / std::max(told, 0.1),
                1e-15);
  }
}

// Without `held` the lag would run to 1e6 behind the limiter, and take 15 time constants back.
TEST(DeltaRelaxationTest, GoesOnFromWhatALimiterLeftOfItsDelta) {
  DiagramBuilder builder;
  const auto& relaxation = builder.Add<DeltaRelaxation>("relaxation", Relax(0.1));
  const auto& limiter = builder.Add<DeltaLimiter>(
      "limiter", DeltaLimiter::Params{.max_joint_velocity = 1.0, .period = Period(1, 100)});
  builder.Connect(relaxation.relaxed_delta, limiter.delta);
  builder.Connect(limiter.limited_delta, relaxation.held);
  builder.ExportInput("delta", relaxation.delta);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  relaxation.delta.Fix(simulator.context(), Eigen::VectorXd::Constant(1, 1e6));
  simulator.AdvanceTo(0.1);
  EXPECT_NEAR(limiter.limited_delta.Eval(simulator.context())[0], 0.1, 1e-12);
  relaxation.delta.Fix(simulator.context(), Eigen::VectorXd::Constant(1, 0.0));
  simulator.AdvanceTo(0.11);
  EXPECT_NEAR(limiter.limited_delta.Eval(simulator.context())[0], 0.09, 1e-12);
}

TEST(DeltaRelaxationTest, RefusesANegativeTimeAndPeriodZero) {
  EXPECT_THROW(DeltaRelaxation(Relax(-1e-9)), ConfigError);
  EXPECT_THROW(DeltaRelaxation({.relaxation_time = 0.1, .period = Period()}), ConfigError);
}

}  // namespace delta_relaxation_test
}  // namespace oca::systems
