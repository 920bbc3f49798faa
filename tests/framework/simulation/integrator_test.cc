// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "oca/framework/simulation/integration_method.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca {
namespace integrator_test {

using blocks::Vec;

class IntegratorTest : public testing::TestWithParam<IntegratorKind> {
 protected:
  bool fixed() const {
    return GetParam() == IntegratorKind::kFixedDp5 || GetParam() == IntegratorKind::kFixedRk4;
  }
  IntegratorOptions Tight() const {
    return {.integrator = GetParam(), .relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
  }
};
INSTANTIATE_TEST_SUITE_P(Integrators, IntegratorTest, testing::ValuesIn(kAllIntegrators),
                         NameOfKind);

class AdaptiveIntegratorTest : public IntegratorTest {};

INSTANTIATE_TEST_SUITE_P(Integrators, AdaptiveIntegratorTest,
                         testing::ValuesIn(kAdaptiveIntegrators), NameOfKind);

/// The state at `end` of x' = f(t, x, 0) from x(0) = `initial`.
double Solve(const blocks::Ode::Function& f, double initial, double end,
             const IntegratorOptions& options, IntegratorStatistics* statistics = nullptr) {
  DiagramBuilder builder;
  const auto& ode = builder.Add<blocks::Ode>("ode", initial, f);
  const auto& zero = builder.Add<blocks::Source>("zero", Vec({0.0}));
  builder.Connect(zero.value, ode.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, options);
  simulator.AdvanceTo(end);
  if (statistics != nullptr) *statistics = simulator.statistics().integrator;
  EXPECT_EQ(simulator.context().time(), end);
  return ode.out.Eval(simulator.context())[0];
}

TEST_P(IntegratorTest, DecaysAsTheExponentialDoes) {
  const double x = Solve([](double, double now, double) { return -now; }, 1.0, 2.0, Tight());
  EXPECT_NEAR(x, std::exp(-2.0), 2e-8);
}

TEST_P(IntegratorTest, ReadsTheTime) {
  const double x = Solve([](double t, double, double) { return std::cos(t); }, 0.0, 3.0, Tight());
  EXPECT_NEAR(x, std::sin(3.0), 2e-8);
}

TEST_P(AdaptiveIntegratorTest, LooserTolerancesCostLessAndErrMore) {
  const auto f = [](double t, double now, double) { return -now + std::sin(5.0 * t); };
  IntegratorStatistics tight, loose;
  Solve(f, 1.0, 5.0, Tight(), &tight);
  Solve(f, 1.0, 5.0, {.integrator = GetParam(), .relative_tolerance = 1e-3}, &loose);
  EXPECT_LT(2 * loose.derivative_calls, tight.derivative_calls);
  EXPECT_GT(loose.steps, 0);
}

TEST_P(IntegratorTest, AValueHeldOverAPeriodIsIntegratedWithoutSmearingItsEdges) {
  // u jumps between +1 and -1 every 10 ms; x' = u, so x is known exactly.
  DiagramBuilder builder;
  const auto& ode =
      builder.Add<blocks::Ode>("ode", 0.0, [](double, double, double u) { return u; });
  const auto& clock = builder.Add<blocks::Clock>(
      "clock", [](double t) { return std::lround(t * 100.0) % 3 == 0 ? 1.0 : -0.25; });
  const auto& hold = builder.Add<blocks::Delay>("hold", Every{Period(1, 100)});
  builder.Connect(clock.value, hold.in);
  builder.Connect(hold.out, ode.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(3.0);
  EXPECT_NEAR(ode.out.Eval(simulator.context())[0], 0.01 * (100 * 1.0 - 200 * 0.25), 1e-12);
}

/// x' = in; what crosses the floor at 0 is thrown back by the reset that runs every period.
class Sawtooth final : public System {
 public:
  Sawtooth() : x_(DeclareContinuousState("x", {1}, 0.0)), out(DeclareStateOutput("out", x_)) {
    DeclareDerivative<&Sawtooth::Rise>(x_);
    DeclareReset<&Sawtooth::Back>(Every{Period(1, 10)}, Writes(x_), x_);
  }

 private:
  void Rise(MutableVectorView derivative) const { derivative[0] = 1.0; }
  void Back(VectorView now, MutableVectorView next) const { next[0] = now[0] - 1.0; }
  const ContinuousState x_;

 public:
  const Output<Vector> out;
};

TEST_P(IntegratorTest, SeesAJumpOfTheStateAtOnce) {
  const auto diagram = MakeDiagramOf(std::make_unique<Sawtooth>());
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(2.0);
  // 20 resets (at 0, 0.1, ..., 1.9) of -1 and a slope of 1 over 2 s.
  EXPECT_NEAR(diagram->GetOutput<Vector>("out").Eval(simulator.context())[0], -18.0, 1e-11);
}

/// A ball that is thrown upwards again at every whole second: v jumps, and h follows.
class Bouncer final : public System {
 public:
  Bouncer()
      : x_(DeclareContinuousState("x", {2}, Vec({0.0, 0.0}))), out(DeclareStateOutput("out", x_)) {
    DeclareDerivative<&Bouncer::Fall>(x_, x_);
    DeclareReset<&Bouncer::Throw>(Every{Period(1, 1)}, Writes(x_), x_);
  }

 private:
  void Fall(VectorView now, MutableVectorView derivative) const {
    derivative[0] = now[1];
    derivative[1] = -10.0;
  }
  void Throw(VectorView now, MutableVectorView next) const {
    next[0] = now[0];
    next[1] = 5.0;
  }
  const ContinuousState x_;

 public:
  const Output<Vector> out;
};

TEST_P(IntegratorTest, ABouncingBallReturnsToTheHeightItLeft) {
  const auto diagram = MakeDiagramOf(std::make_unique<Bouncer>());
  Simulator simulator(*diagram, Tight());
  const auto out = diagram->GetOutput<Vector>("out");
  for (int second = 1; second <= 10; ++second) {
    simulator.AdvanceTo(second - 0.5);
    EXPECT_NEAR(out.Eval(simulator.context())[0], 1.25, 1e-8);  // 5 t - 5 t^2 at 0.5
    simulator.AdvanceTo(second);
    EXPECT_NEAR(out.Eval(simulator.context())[0], 0.0, 1e-8);
    EXPECT_NEAR(out.Eval(simulator.context())[1], -5.0, 1e-8);
  }
}

TEST_P(IntegratorTest, ANewValueOfAFixedInputCountsFromThePresent) {
  const auto diagram =
      MakeDiagramOf(std::make_unique<blocks::Ode>(0.0, [](double, double, double u) { return u; }));
  Simulator simulator(*diagram, {.integrator = GetParam()});
  const auto in = diagram->GetInput<Vector>("in");
  in.Fix(simulator.context(), Vec({1.0}));
  simulator.AdvanceTo(0.5);
  in.Fix(simulator.context(), Vec({-2.0}));
  simulator.AdvanceTo(1.0);
  EXPECT_NEAR(diagram->GetOutput<Vector>("out").Eval(simulator.context())[0], -0.5, 1e-12);
}

TEST_P(IntegratorTest, StepsNoLongerThanAllowed) {
  IntegratorStatistics statistics;
  Solve([](double, double, double) { return 0.0; }, 1.0, 1.0,
        {.integrator = GetParam(), .max_step = 0.01, .fixed_step = 0.01}, &statistics);
  EXPECT_GE(statistics.steps, 100);
  EXPECT_LE(statistics.steps, fixed() ? 100 : 150);
}

TEST_P(AdaptiveIntegratorTest, MoreStepsThanAllowedAreAnErrorWithTheTime) {
  const auto stiff = [](double t, double x, double) { return -1e3 * (x - std::sin(50.0 * t)); };
  EXPECT_THROW(Solve(stiff, 1.0, 10.0, {.integrator = GetParam(), .max_steps = 20}),
               SimulationError);
}

TEST(IntegratorOrderTest, HalvingAFixedStepGainsTheOrderOfTheMethod) {
  const auto f = [](double t, double x, double) { return -x + std::sin(t); };
  const double exact = 1.5 * std::exp(-1.0) + 0.5 * (std::sin(1.0) - std::cos(1.0));
  const auto error = [&](IntegratorKind kind, double h) {
    return std::fabs(Solve(f, 1.0, 1.0, {.integrator = kind, .fixed_step = h}) - exact);
  };
  EXPECT_NEAR(
      std::log2(error(IntegratorKind::kFixedRk4, 0.1) / error(IntegratorKind::kFixedRk4, 0.05)),
      4.0, 0.3);
  EXPECT_NEAR(
      std::log2(error(IntegratorKind::kFixedDp5, 0.2) / error(IntegratorKind::kFixedDp5, 0.1)), 5.0,
      0.5);
}

TEST(FixedStepTest, MoreStepsThanAllowedAreAnErrorAndNotAnEndlessRun) {
  const auto still = [](double, double, double) { return 0.0; };
  for (const IntegratorKind kind : {IntegratorKind::kFixedDp5, IntegratorKind::kFixedRk4}) {
    EXPECT_NO_THROW(
        Solve(still, 1.0, 1.0, {.integrator = kind, .fixed_step = 0.1, .max_steps = 10}));
    EXPECT_THROW(Solve(still, 1.0, 1.0, {.integrator = kind, .fixed_step = 0.1, .max_steps = 9}),
                 SimulationError);
    EXPECT_THROW(Solve(still, 1.0, 1.0, {.integrator = kind, .fixed_step = 1e-300}),
                 SimulationError);
  }
}

TEST(IntegratorOrderTest, AFixedStepDividesAPeriodIntoEqualParts) {
  IntegratorStatistics statistics;
  const auto rest = [](double, double, double) { return 0.0; };
  Solve(rest, 0.0, 0.01, {.integrator = IntegratorKind::kFixedRk4, .fixed_step = 1e-3},
        &statistics);
  EXPECT_EQ(statistics.steps, 10);
  Solve(rest, 0.0, 0.0105, {.integrator = IntegratorKind::kFixedRk4, .fixed_step = 1e-3},
        &statistics);
  EXPECT_EQ(statistics.steps, 11);
}

TEST(IntegratorOrderTest, TolerancesCanBeSetForOneSystem) {
  const auto steps = [](const std::map<std::string, Tolerances>& tolerances) {
    IntegratorStatistics statistics;
    Solve([](double t, double x, double) { return std::cos(9.0 * t) - x; }, 0.0, 3.0,
          {.tolerances = tolerances}, &statistics);
    return statistics.steps;
  };
  EXPECT_GT(steps({{"ode", {1e-10, 1e-12}}}), 2 * steps({}));
  EXPECT_THROW(steps({{"odd", {1e-10, 1e-12}}}), ConfigError);
  EXPECT_THROW(steps({{"zero", {1e-10, 1e-12}}}), ConfigError);
  EXPECT_THROW(steps({{"ode", {0.0, 1e-12}}}), ConfigError);
  EXPECT_THROW(steps({{"ode", {1e-10, -1.0}}}), ConfigError);
  EXPECT_THROW(steps({{"ode", {2.0, 1e-12}}}), ConfigError);  // as of all systems: at most 1
}

}  // namespace integrator_test
}  // namespace oca
