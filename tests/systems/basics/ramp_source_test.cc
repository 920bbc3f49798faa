// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/ramp_source.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/integrator.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace ramp_source_test {

RampSource::Params RampFromAThird() {
  return {.slope = 3.0, .initial = 1.0, .start = Period(1, 3)};
}

TEST(RampSourceTest, RestsThenRises) {
  SystemBench<RampSource> bench(RampFromAThird());
  const double expected[][2] = {{0.0, 1.0}, {1.0 / 3.0, 1.0}, {0.5, 1.5}, {1.0, 3.0}};
  for (const auto& [time, value] : expected) {
    bench.AdvanceTo(time);
    EXPECT_NEAR(bench->value.Eval(bench.context())[0], value, 1e-15) << time;
  }
}

TEST(RampSourceTest, NoIntegratorStepsAcrossTheCorner) {
  DiagramBuilder builder;
  const auto& ramp = builder.Add<RampSource>("ramp", RampFromAThird());
  const auto& integrator = builder.Add<Integrator>("integrator", Integrator::Params{});
  builder.Connect(ramp.value, integrator.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(1.0);
  // 1 + 3 (2/3)^2 / 2
  EXPECT_NEAR(integrator.out.Eval(simulator.context())[0], 1.0 + 2.0 / 3.0, 1e-14);
}

TEST(RampSourceTest, ARunThatBeginsLateHasTheCornerBehindIt) {
  SystemBench<RampSource> bench(RampFromAThird());
  bench.context().SetTime(0.5);
  bench.AdvanceTo(1.0);
  EXPECT_DOUBLE_EQ(bench->value.Eval(bench.context())[0], 3.0);
}

TEST(RampSourceTest, RefusesANegativeStartAndNaN) {
  EXPECT_THROW(RampSource({.start = Period(-1, 3)}), ConfigError);
  EXPECT_THROW(RampSource({.slope = std::numeric_limits<double>::quiet_NaN()}), ConfigError);
}

}  // namespace ramp_source_test
}  // namespace oca::systems
