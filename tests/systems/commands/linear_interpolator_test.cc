// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/linear_interpolator.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace linear_interpolator_test {

Eigen::VectorXd One(double value) { return Eigen::VectorXd::Constant(1, value); }

/// Up 1 in 0.5 s, down 3 in 1 s.
LinearInterpolator::Params UpAndDown() {
  return {.key_points = {{.time = 0.5, .position = One(0.0), .velocity = One(9.0)},
                         {.time = 1.0, .position = One(1.0)},
                         {.time = 2.0, .position = One(-2.0)}}};
}

TEST(LinearInterpolatorTest, ConnectsKeyPointsByLines) {
  SystemBench<LinearInterpolator> bench(UpAndDown());
  const double expected[][3] = {// time, position, velocity
                                {0.25, 0.0, 0.0}, {0.5, 0.0, 2.0},   {0.75, 0.5, 2.0},
                                {1.0, 1.0, -3.0}, {1.5, -0.5, -3.0}, {2.5, -2.0, 0.0}};
  for (const auto& [time, position, velocity] : expected) {
    bench.AdvanceTo(time);
    EXPECT_DOUBLE_EQ(bench->position.Eval(bench.context())[0], position) << time;
    EXPECT_DOUBLE_EQ(bench->velocity.Eval(bench.context())[0], velocity) << time;
    EXPECT_EQ(bench->acceleration.Eval(bench.context())[0], 0.0) << time;
  }
  EXPECT_EQ(bench->goal.Eval(bench.context())[0], -2.0);
}

TEST(LinearInterpolatorTest, SampledShowsTheRequestForTheEndOfThePeriod) {
  auto params = UpAndDown();
  params.period = Period(1, 4);
  SystemBench<LinearInterpolator> bench(params);
  bench.AdvanceTo(0.5);
  EXPECT_EQ(bench->position.Eval(bench.context())[0], 0.0);
  bench.AdvanceTo(0.51);
  EXPECT_DOUBLE_EQ(bench->position.Eval(bench.context())[0], 0.5);
  EXPECT_DOUBLE_EQ(bench->velocity.Eval(bench.context())[0], 2.0);
}

TEST(LinearInterpolatorTest, SampledEndsItsPeriodAtATickAndNotARoundingBefore) {
  LinearInterpolator::Params params{.key_points = {{.time = 0.0, .position = One(0.0)},
                                                   {.time = 0.8, .position = One(0.8)},
                                                   {.time = 1.0, .position = One(0.0)}}};
  params.period = Period(1, 10);
  SystemBench<LinearInterpolator> bench(params);
  bench.AdvanceTo(0.75);
  EXPECT_LT(0.7 + 0.1, 0.8);  // where the rate was still that of the segment before
  EXPECT_DOUBLE_EQ(bench->velocity.Eval(bench.context())[0], -4.0);
  EXPECT_EQ(bench->position.Eval(bench.context())[0], 0.8);
}

TEST(LinearInterpolatorTest, RefusesNoKeyPointsAndANegativePeriod) {
  EXPECT_THROW(LinearInterpolator(LinearInterpolator::Params{}), ConfigError);
  auto params = UpAndDown();
  params.period = Period(-1, 4);
  EXPECT_THROW(LinearInterpolator{params}, ConfigError);
}

}  // namespace linear_interpolator_test
}  // namespace oca::systems
