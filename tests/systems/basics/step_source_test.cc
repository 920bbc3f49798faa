// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/step_source.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/integrator.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace step_source_test {

constexpr double kThird = 1.0 / 3.0;  // s

StepSource::Params StepAtAThird() {
  return {.time = Period(1, 3), .initial = -1.0, .final = 2.0, .unit = "m/s"};
}

TEST(StepSourceTest, SwitchesRightAfterItsTime) {
  SystemBench<StepSource> bench(StepAtAThird());
  bench.AdvanceTo(kThird);
  EXPECT_EQ(bench->value.Eval(bench.context())[0], -1.0);
  bench.AdvanceTo(std::nextafter(kThird, 1.0));
  EXPECT_EQ(bench->value.Eval(bench.context())[0], 2.0);
  bench.AdvanceTo(100.0);
  EXPECT_EQ(bench->value.Eval(bench.context())[0], 2.0);
}

TEST(StepSourceTest, NoIntegratorStepsAcrossTheSwitch) {
  DiagramBuilder builder;
  const auto& step = builder.Add<StepSource>("step", StepAtAThird());
  const auto& integrator = builder.Add<Integrator>("integrator", Integrator::Params{});
  builder.Connect(step.value, integrator.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(1.0);
  EXPECT_NEAR(integrator.out.Eval(simulator.context())[0], -kThird + 2.0 * 2.0 / 3.0, 1e-15);
}

TEST(StepSourceTest, ARunThatBeginsLateHasTheStepBehindIt) {
  SystemBench<StepSource> bench(StepAtAThird());
  bench.context().SetTime(0.5);
  bench.AdvanceTo(0.6);
  EXPECT_EQ(bench->value.Eval(bench.context())[0], 2.0);
}

TEST(StepSourceTest, RefusesANegativeTimeAndListsOfDifferentLength) {
  EXPECT_THROW(StepSource({.time = Period(-1, 3)}), ConfigError);
  EXPECT_THROW(StepSource({.initial = Eigen::VectorXd(Eigen::Vector2d::Ones()),
                           .final = Eigen::VectorXd(Eigen::Vector3d::Ones())}),
               ConfigError);
}

}  // namespace step_source_test
}  // namespace oca::systems
