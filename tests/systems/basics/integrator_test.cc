// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/integrator.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/constant.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace integrator_test {

TEST(IntegratorTest, IntegratesAConstant) {
  SystemBench<Integrator> bench(
      Integrator::Params{.initial = Eigen::VectorXd(Eigen::Vector2d(1.0, 2.0))});
  bench->in.Fix(bench.context(), Eigen::Vector2d(0.5, -2.0));
  bench.AdvanceTo(3.0);
  EXPECT_NEAR(bench->out.Eval(bench.context())[0], 2.5, 1e-14);
  EXPECT_NEAR(bench->out.Eval(bench.context())[1], -4.0, 1e-14);
}

TEST(IntegratorTest, ItsInputHasTheRateOfItsUnit) {
  for (const char* unit : {"m/s", "m"}) {
    DiagramBuilder builder;
    const auto& constant =
        builder.Add<Constant>("constant", Constant::Params{.value = 1.0, .unit = unit});
    const auto& integrator = builder.Add<Integrator>("integrator", Integrator::Params{.unit = "m"});
    builder.Connect(constant.value, integrator.in);
    if (unit == std::string("m/s")) {
      EXPECT_NO_THROW(builder.Build());
    } else {
      EXPECT_THROW(builder.Build(), WiringError);
    }
  }
}

TEST(IntegratorTest, RefusesAnInitialValueThatIsNotFinite) {
  EXPECT_THROW(Integrator({.initial = std::numeric_limits<double>::infinity()}), ConfigError);
}

}  // namespace integrator_test
}  // namespace oca::systems
