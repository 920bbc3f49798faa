// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, line 5: witness functions and the resets that wait for them.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"
#include "tests/framework/simulation/witness_blocks.h"

namespace oca {
namespace witness_test {

using blocks::Vec;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

class WitnessTest : public testing::TestWithParam<IntegratorKind> {
 protected:
  IntegratorOptions Tight() const {
    return {.integrator = GetParam(), .relative_tolerance = 1e-13, .absolute_tolerance = 1e-14};
  }
};

INSTANTIATE_TEST_SUITE_P(Integrators, WitnessTest, testing::ValuesIn(kAllIntegrators), NameOfKind);

// t1 = sqrt(2 h / g); each flight e times the one before: t_n = t1 (1 + 2 (e + ... + e^(n-1))).
TEST_P(WitnessTest, Line5ABallBouncesWhenItShould) {
  const auto diagram = MakeDiagramOf(std::make_unique<Ball>());
  const auto& ball = static_cast<const Ball&>(*diagram->FindSystem("system"));
  Simulator simulator(*diagram, Tight());
  simulator.AdvanceTo(3.6);
  ASSERT_THAT(ball.bounces, SizeIs(10));
  EXPECT_NEAR(ball.bounces[0], 0.4515236409857309, 1e-10);
  EXPECT_NEAR(ball.bounces[4], 2.584160102089535, 1e-10);
  EXPECT_NEAR(ball.bounces[9], 3.578892951020438, 1e-10);
  EXPECT_EQ(simulator.statistics().crossings, 10);
}

TEST_P(WitnessTest, Line5AZenoGuardStopsWithAnErrorThatNamesTheWitnessAndTheLimit) {
  const auto diagram = MakeDiagramOf(std::make_unique<Ball>());
  const auto& ball = static_cast<const Ball&>(*diagram->FindSystem("system"));
  Simulator simulator(*diagram, Tight());
  simulator.AdvanceTo(4.063);
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      simulator.AdvanceTo(5.0);
      FAIL() << "a ball at rest was integrated";
    } catch (const SimulationError& error) {
      EXPECT_EQ(error.system, "system");
      EXPECT_EQ(error.port, "ground");
      EXPECT_LT(error.time, 4.063712768871578);
      EXPECT_THAT(error.what(), HasSubstr("(Zeno) towards t = 4.06371276"));
    }
  }
  EXPECT_GT(ball.bounces.size(), 39u);
}

TEST_P(WitnessTest, Line5AtTheUsualTolerancesABallIsStoppedBeforeItFallsThrough) {
  const auto diagram = MakeDiagramOf(std::make_unique<Ball>());
  Simulator simulator(*diagram, {.integrator = GetParam()});
  EXPECT_THROW(simulator.AdvanceTo(5.0), SimulationError);
  EXPECT_NEAR(simulator.context().time(), 4.063712768871578, 1e-3);
}

TEST_P(WitnessTest, Line5ABallThatWatchesBothDirectionsBouncesNoMoreOften) {
  const auto diagram = MakeDiagramOf(std::make_unique<Ball>(0.8, Direction::kBoth));
  const auto& ball = static_cast<const Ball&>(*diagram->FindSystem("system"));
  Simulator simulator(*diagram, Tight());
  simulator.AdvanceTo(3.6);
  ASSERT_THAT(ball.bounces, SizeIs(10));
  EXPECT_NEAR(ball.bounces[9], 3.578892951020438, 1e-10);
}

// First tau ln((30-20)/(30-21)); then in turn tau ln(6/4) cooling and tau ln(11/9) heating.
TEST_P(WitnessTest, Line5AThermostatSwitchesWhenTheExponentialsCross) {
  const auto diagram = MakeDiagramOf(std::make_unique<Thermostat>());
  const auto& thermostat = static_cast<const Thermostat&>(*diagram->FindSystem("system"));
  Simulator simulator(*diagram, Tight());
  simulator.AdvanceTo(60.0);
  ASSERT_THAT(thermostat.switches, SizeIs(20));
  EXPECT_NEAR(thermostat.switches[0], 10.0 * std::log(10.0 / 9.0), 1e-10);
  EXPECT_NEAR(thermostat.switches[19], 59.66047855898831, 1e-8);
}

TEST_P(WitnessTest, Line5ACrossingAtATickHappensInOneStepWithIt) {
  DiagramBuilder builder;
  const auto& one = builder.Add<blocks::Source>("one", Vec({1.0}));
  const auto& ode =
      builder.Add<blocks::Ode>("ode", 0.0, [](double, double, double u) { return u; });
  const auto& alarm = builder.Add<Alarm>("alarm", [](double, double x) {
    return std::sin(10.0 * std::numbers::pi * (x - 0.05) + 0.5 * std::numbers::pi);
  });
  const auto& counter = builder.Add<blocks::Counter>("counter", Every{Period(1, 10)});
  const auto& hold = builder.Add<blocks::Delay>("hold", Every{Period(1, 10)});
  builder.Connect(one.value, ode.in);
  builder.Connect(ode.out, alarm.in);
  builder.Connect(alarm.out, hold.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  std::vector<double> steps;
  simulator.AddMonitor([&](const Context& context) {
    steps.push_back(context.time());
    return true;
  });
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(alarm.times, SizeIs(9)) << "at 1 s it is pending";
  for (std::size_t i = 0; i < alarm.times.size(); ++i) {
    EXPECT_EQ(alarm.times[i], static_cast<double>(i + 1) / 10.0);
  }
  EXPECT_THAT(steps, SizeIs(10));
  EXPECT_THAT(counter.times, SizeIs(10));
  // The resets come first: the updates of the same instant read what they wrote.
  EXPECT_EQ(hold.out.Eval(simulator.context())[0], 9.0);
}

TEST_P(WitnessTest, Line5SimultaneousCrossingsReadTheSameState) {
  for (const double apart : {0.0, 5e-13}) {
    const auto diagram = MakeDiagramOf(std::make_unique<Twins>(apart));
    const auto& twins = static_cast<const Twins&>(*diagram->FindSystem("system"));
    Simulator simulator(*diagram, {.integrator = GetParam()});
    simulator.AdvanceTo(1.0);
    EXPECT_EQ(twins.a.Get(simulator.context())[0], 10.0) << "swapped " << apart;
    EXPECT_EQ(twins.b.Get(simulator.context())[0], 1.0);
    EXPECT_EQ(simulator.statistics().crossings, 1);
  }
}

TEST_P(WitnessTest, Line5CrossingsThatFollowEachOtherAreStepsInTheirOrder) {
  const auto diagram = MakeDiagramOf(std::make_unique<Twins>(1e-9));
  const auto& twins = static_cast<const Twins&>(*diagram->FindSystem("system"));
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(twins.a.Get(simulator.context())[0], 10.0);
  EXPECT_EQ(twins.b.Get(simulator.context())[0], 10.0);
  EXPECT_EQ(simulator.statistics().crossings, 2);
}

TEST_P(WitnessTest, Line3AdvanceToACrossingLeavesItsResetPending) {
  const auto diagram = MakeDiagramOf(std::make_unique<Twins>(0.5));
  const auto& twins = static_cast<const Twins&>(*diagram->FindSystem("system"));
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(0.3);
  EXPECT_EQ(simulator.statistics().crossings, 1);
  EXPECT_EQ(twins.a.Get(simulator.context())[0], 1.0);
  const Context saved = simulator.context();
  simulator.AdvanceTo(0.4);
  EXPECT_EQ(twins.a.Get(simulator.context())[0], 10.0);
  Simulator resumed(*diagram, saved, {.integrator = GetParam()});
  resumed.AdvanceTo(0.4);
  EXPECT_EQ(twins.a.Get(resumed.context())[0], 10.0);
  EXPECT_EQ(resumed.statistics().crossings, 0);
}

TEST_P(WitnessTest, Line6ARunSavedAtAnyBounceResumesWithTheSameBits) {
  const auto diagram = MakeDiagramOf(std::make_unique<Ball>());
  const auto& ball = static_cast<const Ball&>(*diagram->FindSystem("system"));
  Simulator straight(*diagram, {.integrator = GetParam()});
  std::vector<Context> saved;
  straight.AddMonitor([&](const Context& context) {
    saved.push_back(context);
    return true;
  });
  straight.AdvanceTo(3.9);
  ASSERT_GT(saved.size(), 10u);
  const std::vector<double> bounces = ball.bounces;
  for (std::size_t i = 0; i + 1 < saved.size(); ++i) {
    ball.bounces.clear();
    Simulator resumed(*diagram, saved[i], {.integrator = GetParam()});
    resumed.AdvanceTo(3.9);
    EXPECT_EQ(ball.x.Get(resumed.context()), ball.x.Get(straight.context())) << i;
    EXPECT_EQ(ball.bounces,
              std::vector<double>(bounces.begin() + static_cast<long>(i), bounces.end()));
  }
}

TEST_P(WitnessTest, Line5WitnessesOfNestedDiagramsReadTheirInputs) {
  DiagramBuilder inner;
  const auto& alarm = inner.Add<Alarm>("alarm", [](double, double x) { return x - 0.25; });
  inner.ExportInput("level", alarm.in);
  DiagramBuilder middle;
  const auto& nested = middle.AddSystem("inner", inner.Build());
  middle.ExportInput("level", nested.FindInput("level"));
  DiagramBuilder outer;
  const auto& one = outer.Add<blocks::Source>("one", Vec({1.0}));
  const auto& ode = outer.Add<blocks::Ode>("ode", 0.0, [](double, double, double u) { return u; });
  const auto& map = outer.Add<blocks::Map>("map", [](double x) { return 0.5 * x; });
  const auto& deep = outer.AddSystem("middle", middle.Build());
  outer.Connect(one.value, ode.in);
  outer.Connect(ode.out, map.in);
  outer.ConnectPorts(map.out, deep.FindInput("level"));
  const auto diagram = outer.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(alarm.times, ElementsAre(DoubleNear(0.5, 1e-10)));
}

TEST_P(WitnessTest, Line7AWitnessThatFailsIsNamedAndTheRunGoesOnOnceItIsHealed) {
  for (const bool throws : {false, true}) {
    bool broken = true;
    const Watched watched([&](double, double x) {
      if (!broken || x < 0.55) return x - 0.7;
      if (throws) throw std::runtime_error("broken on purpose");
      return std::numeric_limits<double>::quiet_NaN();
    });
    Simulator simulator(*watched.diagram, {.integrator = GetParam()});
    simulator.AdvanceTo(0.5);
    for (int attempt = 0; attempt < 2; ++attempt) {
      try {
        simulator.AdvanceTo(1.0);
        FAIL() << "nothing thrown";
      } catch (const SimulationError& error) {
        EXPECT_EQ(error.system, "alarm");
        EXPECT_EQ(error.port, "level");
        EXPECT_GE(error.time, 0.55 - 1e-12);
        EXPECT_THAT(error.what(), HasSubstr(throws ? "broken on purpose" : "is not finite"));
      }
      EXPECT_EQ(simulator.context().time(), 0.5);
    }
    broken = false;
    simulator.AdvanceTo(1.0);
    EXPECT_THAT(watched.alarm->times, ElementsAre(DoubleNear(0.7, 1e-10)));
  }
}

TEST_P(WitnessTest, Line7TooManyStepsBetweenEventsAreAnError) {
  const Watched watched([](double, double x) { return x - 20.0; });
  Simulator simulator(
      *watched.diagram,
      {.integrator = GetParam(), .max_step = 0.01, .fixed_step = 0.01, .max_steps = 50});
  simulator.AdvanceTo(0.2);
  try {
    simulator.AdvanceTo(10.0);
    FAIL() << "nothing thrown";
  } catch (const SimulationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("got 50 steps since the last event"));
    EXPECT_GT(error.time, 0.6);
  }
  EXPECT_EQ(simulator.context().time(), 0.2);
  simulator.AdvanceTo(0.4);
}

class Wrong final : public System {
 public:
  explicit Wrong(const Witness* other) : count(DeclareDiscreteState("count", {1}, 0.0)) {
    const Witness mine = DeclareWitness<&Wrong::Zero>("mine", Direction::kBoth);
    if (other == nullptr) DeclareWitness<&Wrong::Zero>("mine", Direction::kRising);
    DeclareReset<&Wrong::Note>(When{other == nullptr ? mine : *other}, Writes(count));
  }
  const DiscreteState<Vector> count;

 private:
  double Zero() const { return 0.0; }
  void Note(MutableVectorView) const {}
};

TEST(WitnessDeclarationTest, RefusesASecondWitnessOfOneNameAndAForeignOne) {
  EXPECT_THROW(Wrong(nullptr), WiringError);
  const Witness foreign;
  EXPECT_THROW(Wrong wrong(&foreign), WiringError);
}

}  // namespace witness_test
}  // namespace oca
