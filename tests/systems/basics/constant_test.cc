// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/constant.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/gain.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace constant_test {

TEST(ConstantTest, ShowsItsValueAtAnyTime) {
  SystemBench<Constant> bench(Constant::Example());
  EXPECT_EQ(Eigen::Vector2d(bench->value.Eval(bench.context())), Eigen::Vector2d(1.0, -2.0));
  bench.AdvanceTo(3.0);
  EXPECT_EQ(Eigen::Vector2d(bench->value.Eval(bench.context())), Eigen::Vector2d(1.0, -2.0));
}

TEST(ConstantTest, ANumberFillsTheLengthThatIsConnected) {
  DiagramBuilder builder;
  const auto& constant = builder.Add<Constant>("constant", Constant::Params{.value = 3.0});
  const auto& gain =
      builder.Add<Gain>("gain", Gain::Params{.gain = Eigen::VectorXd(Eigen::Vector2d(1.0, 10.0))});
  builder.Connect(constant.value, gain.in);
  const auto diagram = builder.Build();
  const Context context = diagram->MakeContext();
  EXPECT_EQ(Eigen::Vector2d(gain.out.Eval(context)), Eigen::Vector2d(3.0, 30.0));
}

TEST(ConstantTest, RefusesNaNAndNothing) {
  EXPECT_THROW(Constant({.value = std::numeric_limits<double>::quiet_NaN()}), ConfigError);
  EXPECT_THROW(Constant({.value = Eigen::VectorXd()}), ConfigError);
}

}  // namespace constant_test
}  // namespace oca::systems
