// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/delta_limiter.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace delta_limiter_test {

DeltaLimiter::Params Limit(const PerComponent& max_joint_velocity) {
  return {.max_joint_velocity = max_joint_velocity, .period = Period(1, 100)};
}

/// The output after all updates up to number `tick`, which from now on see `raw`.
Eigen::VectorXd After(SystemBench<DeltaLimiter>& bench, int tick, const Eigen::VectorXd& raw) {
  bench->delta.Fix(bench.context(), raw);
  bench.AdvanceTo(tick / 100.0);
  return bench->limited_delta.Eval(bench.context());
}

TEST(DeltaLimiterTest, GivesTheGoldenValuesOfTheFirstTick) {
  // One joint at a time: raw, limited (docs/theory.md, Limiter and overlay).
  const double golden[][2] = {{1, .006},    {-1, -.006},   {.003, .003}, {-.003, -.003},
                              {.006, .006}, {.0061, .006}, {0, 0}};
  for (const auto& [raw, limited] : golden) {
    SystemBench<DeltaLimiter> fresh(Limit(0.6));
    EXPECT_DOUBLE_EQ(After(fresh, 1, Eigen::VectorXd::Constant(1, raw))[0], limited) << raw;
  }
}

TEST(DeltaLimiterTest, ReturnsToZeroNoFasterThanItLeft) {
  SystemBench<DeltaLimiter> bench(Limit(0.6));
  ASSERT_EQ(After(bench, 20, Eigen::VectorXd::Constant(1, 0.1))[0], 0.1);
  EXPECT_DOUBLE_EQ(After(bench, 21, Eigen::VectorXd::Zero(1))[0], 0.094);
}

TEST(DeltaLimiterTest, LimitsEachJointByItsOwnVelocity) {
  SystemBench<DeltaLimiter> bench(Limit(Eigen::VectorXd(Eigen::Vector2d(1.0, 2.0))));
  const Eigen::VectorXd x = After(bench, 1, Eigen::Vector2d(5.0, -5.0));
  EXPECT_DOUBLE_EQ(x[0], 0.01);
  EXPECT_DOUBLE_EQ(x[1], -0.02);
}

// The first joint may go 0.01, so all go a hundredth of their way.
TEST(DeltaLimiterTest, KeepsTheDirectionOfTheWholeChangeInThatMode) {
  auto params = Limit(Eigen::VectorXd(Eigen::Vector3d(1.0, 1.0, 2.0)));
  params.mode = DeltaLimiter::Mode::kDirection;
  SystemBench<DeltaLimiter> bench(params);
  const Eigen::VectorXd x = After(bench, 1, Eigen::Vector3d(1.0, -0.5, 1.5));
  EXPECT_NEAR((x - Eigen::Vector3d(0.01, -0.005, 0.015)).norm(), 0.0, 1e-15);
  const Eigen::VectorXd y = After(bench, 2, Eigen::Vector3d(0.01, -0.005, 4.015));
  EXPECT_NEAR((y - Eigen::Vector3d(0.01, -0.005, 0.035)).norm(), 0.0, 1e-15);
}

TEST(DeltaLimiterTest, PassesAChangeAtTheLimitBitByBitInThatMode) {
  auto params = Limit(Eigen::VectorXd(Eigen::Vector2d(1.0, 1.0)));
  params.mode = DeltaLimiter::Mode::kDirection;
  SystemBench<DeltaLimiter> bench(params);
  const Eigen::VectorXd raw = Eigen::Vector2d(0.01, 0.003);
  EXPECT_EQ(After(bench, 1, raw), raw);
  EXPECT_LT(After(bench, 2, raw + Eigen::Vector2d(0.0101, 0.001))[1], 0.004);
}

TEST(DeltaLimiterTest, HoldsItsOutputWhileTheInputMoves) {
  SystemBench<DeltaLimiter> bench(Limit(0.6));
  After(bench, 1, Eigen::VectorXd::Constant(1, 1.0));
  bench->delta.Fix(bench.context(), Eigen::VectorXd::Constant(1, -1.0));
  EXPECT_DOUBLE_EQ(bench->limited_delta.Eval(bench.context())[0], 0.006);
}

TEST(DeltaLimiterTest, StartsAtZero) {
  SystemBench<DeltaLimiter> bench(Limit(0.6));
  EXPECT_EQ(bench->limited_delta.Eval(bench.context())[0], 0.0);
}

TEST(DeltaLimiterTest, PassesAnyDeltaWhenDisabled) {
  auto params = Limit(0.6);
  params.enabled = false;
  SystemBench<DeltaLimiter> bench(params);
  EXPECT_EQ(After(bench, 1, Eigen::VectorXd::Constant(1, 1e5))[0], 1e5);
}

TEST(DeltaLimiterTest, RefusesAVelocityThatWouldFreezeTheDelta) {
  EXPECT_THROW(DeltaLimiter{Limit(0.0)}, ConfigError);
  EXPECT_THROW(DeltaLimiter{Limit(std::numeric_limits<double>::quiet_NaN())}, ConfigError);
  EXPECT_THROW(DeltaLimiter{Limit(Eigen::VectorXd())}, ConfigError);
  EXPECT_NO_THROW(DeltaLimiter{Limit(1e-9)});
}

TEST(DeltaLimiterTest, RefusesPeriodZero) {
  EXPECT_THROW(DeltaLimiter({.max_joint_velocity = 0.6, .period = Period()}), ConfigError);
}

}  // namespace delta_limiter_test
}  // namespace oca::systems
