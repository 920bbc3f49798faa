// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/zero_order_hold.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/ramp_source.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace zero_order_hold_test {

TEST(ZeroOrderHoldTest, HoldsTheSampleUpToAndIncludingTheNextTick) {
  DiagramBuilder builder;
  const auto& ramp = builder.Add<RampSource>("ramp", RampSource::Params{.initial = 5.0});
  const auto& hold = builder.Add<ZeroOrderHold>(
      "hold", ZeroOrderHold::Params{.period = Period(1, 10), .initial = -1.0});
  builder.Connect(ramp.value, hold.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  EXPECT_EQ(hold.out.Eval(simulator.context())[0], -1.0);
  const double expected[][2] = {{0.05, 5.0}, {0.1, 5.0}, {0.11, 5.1}, {0.2, 5.1}, {0.25, 5.2}};
  for (const auto& [time, value] : expected) {
    simulator.AdvanceTo(time);
    EXPECT_DOUBLE_EQ(hold.out.Eval(simulator.context())[0], value) << time;
  }
}

TEST(ZeroOrderHoldTest, RefusesPeriodZeroAndNoInitialValue) {
  EXPECT_THROW(ZeroOrderHold({.period = Period()}), ConfigError);
  EXPECT_THROW(ZeroOrderHold({.period = Period(1, 10), .initial = Eigen::VectorXd()}), ConfigError);
}

}  // namespace zero_order_hold_test
}  // namespace oca::systems
