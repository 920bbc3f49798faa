// SPDX-License-Identifier: BSD-3-Clause
// The error of a method of order p falls by 2^p when its step is halved.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"
#include "tests/verification/plants.h"

namespace oca::verification {
namespace order_test {

constexpr int kCoarse = 20;  // steps a second

IntegratorOptions StepsASecond(IntegratorKind kind, int steps) {
  IntegratorOptions options{.integrator = kind, .fixed_step = 1.0 / steps};
  // So loose that an adaptive method accepts every step that events allow it.
  options.relative_tolerance = 1.0;
  options.absolute_tolerance = 1e6;
  return options;
}

/// Runs to `end` in equal steps: adaptive methods find an event at the end of each. Only the first
/// of these they divide, because their very first step is a cautious guess.
void Run(Simulator& simulator, double end, int steps) {
  simulator.AddPublish(Period(1, steps), [](const Context&) {});
  simulator.AdvanceTo(end);
  const std::int64_t expected = std::llround(end * steps);
  ASSERT_GE(simulator.statistics().integrator.steps, expected);
  ASSERT_LE(simulator.statistics().integrator.steps, expected + 8);
}

/// x' = -2 t x^2, x(0) = 1, so x(t) = 1 / (1 + t^2): neither linear nor autonomous, so that no
/// order condition goes unseen.
double BellError(IntegratorKind kind, int steps) {
  DiagramBuilder builder;
  const auto& ode = builder.Add<blocks::Ode>(
      "ode", 1.0, [](double t, double x, double) { return -2.0 * t * x * x; });
  const auto& zero = builder.Add<blocks::Source>("zero", blocks::Vec({0.0}));
  builder.Connect(zero.value, ode.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, StepsASecond(kind, steps));
  Run(simulator, 2.0, steps);
  return std::fabs(ode.out.Eval(simulator.context())[0] - 0.2);
}

/// The half-damped servo of the plants.
double ServoError(IntegratorKind kind, int steps) {
  const Plant plant = PlantNamed("servo_half_damped").make();
  Simulator simulator(*plant.diagram, StepsASecond(kind, steps));
  Run(simulator, plant.end, steps);
  return std::fabs(plant.answers[0].output.Eval(simulator.context())[0] - plant.answers[0].value);
}

struct Method {
  IntegratorKind kind;
  double order;
};

std::string NameOf(const testing::TestParamInfo<Method>& info) {
  return EnumNames(info.param.kind)[static_cast<std::size_t>(info.param.kind)];
}

class OrderTest : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, OrderTest,
                         testing::Values(Method{IntegratorKind::kErkDp5, 5.0},
                                         Method{IntegratorKind::kErkBs3, 3.0},
                                         Method{IntegratorKind::kFixedDp5, 5.0},
                                         Method{IntegratorKind::kFixedRk4, 4.0}),
                         NameOf);

TEST_P(OrderTest, HalvingTheStepGainsItsOrderOnANonlinearProblem) {
  const auto [kind, order] = GetParam();
  for (const int steps : {kCoarse, 2 * kCoarse, 4 * kCoarse}) {
    EXPECT_NEAR(std::log2(BellError(kind, steps) / BellError(kind, 2 * steps)), order, 0.35)
        << steps;
  }
}

TEST_P(OrderTest, HalvingTheStepGainsItsOrderOnAServo) {
  const auto [kind, order] = GetParam();
  for (const int steps : {200, 400}) {
    EXPECT_NEAR(std::log2(ServoError(kind, steps) / ServoError(kind, 2 * steps)), order, 0.35)
        << steps;
  }
}

}  // namespace order_test
}  // namespace oca::verification
