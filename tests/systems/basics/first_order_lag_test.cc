// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/first_order_lag.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace first_order_lag_test {

TEST(FirstOrderLagTest, CoversAStepExponentially) {
  SystemBench<FirstOrderLag> bench(FirstOrderLag::Params{
      .time_constant = Eigen::VectorXd(Eigen::Vector2d(0.05, 0.1)), .initial = 1.0});
  bench->in.Fix(bench.context(), Eigen::Vector2d(3.0, -1.0));
  bench.AdvanceTo(0.1);
  EXPECT_NEAR(bench->out.Eval(bench.context())[0], 3.0 - 2.0 * std::exp(-2.0), 1e-6);
  EXPECT_NEAR(bench->out.Eval(bench.context())[1], -1.0 + 2.0 * std::exp(-1.0), 1e-6);
}

TEST(FirstOrderLagTest, RefusesATimeConstantThatIsNotPositive) {
  EXPECT_THROW(FirstOrderLag({.time_constant = 0.0}), ConfigError);
  EXPECT_NO_THROW(FirstOrderLag({.time_constant = 1e-9}));
  EXPECT_THROW(FirstOrderLag({.initial = Eigen::VectorXd()}), ConfigError);
}

}  // namespace first_order_lag_test
}  // namespace oca::systems
