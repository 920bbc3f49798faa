// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, line 6: a System is const, a Context is a value.
#include "oca/framework/dataflow/context.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca {
namespace context_test {

using blocks::Vec;

/// A pendulum under a sampled controller, slower counters beside it, and objects in the Context.
struct Loop {
  Loop() {
    DiagramBuilder builder;
    const auto& clock =
        builder.Add<blocks::Clock>("clock", [](double t) { return std::sin(7.0 * t); });
    const auto& ode = builder.Add<blocks::Ode>("ode", 0.5, [](double t, double x, double u) {
      return std::cos(3.0 * t) - 2.0 * std::sin(x) + u;
    });
    const auto& control = builder.Add<blocks::Map>("control", [](double x) { return -1.5 * x; });
    const auto& sum = builder.Add<blocks::Sum>("sum");
    const auto& hold = builder.Add<blocks::Delay>("hold", Every{Period(1, 100)});
    const auto& slow = builder.Add<blocks::Delay>("slow", Every{Period(1, 30)});
    const auto& labeller = builder.Add<blocks::Labeller>("labeller", Every{Period(7, 1000)});
    builder.Connect(ode.out, control.in);
    builder.Connect(control.out, sum.in0);
    builder.Connect(slow.out, sum.in1);
    builder.Connect(clock.value, slow.in);
    builder.Connect(sum.out, hold.in);
    builder.Connect(hold.out, ode.in);
    builder.Connect(ode.out, labeller.in);
    builder.ExportOutput("x", ode.out);
    builder.ExportOutput("label", labeller.held);
    diagram = builder.Build();
  }
  std::string Fingerprint(const Context& context) const {
    const double x = diagram->GetOutput<Vector>("x").Eval(context)[0];
    char bits[32];
    std::snprintf(bits, sizeof bits, "%a", x);
    return bits + (" " + diagram->GetOutput<Label>("label").Eval(context).text);
  }
  std::unique_ptr<Diagram> diagram;
};

class ContextTest : public testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, ContextTest, testing::ValuesIn(kAllIntegrators), NameOfKind);

TEST_P(ContextTest, Line6ASavedContextResumedGivesTheSameBits) {
  const Loop loop;
  for (const double save_at : {0.0, 0.1, 0.5, 0.5173}) {
    Simulator first(*loop.diagram, {.integrator = GetParam()});
    first.AdvanceTo(save_at);
    const Context saved = first.context();
    first.AdvanceTo(1.7);
    Simulator second(*loop.diagram, saved, {.integrator = GetParam()});
    second.AdvanceTo(1.7);
    EXPECT_EQ(loop.Fingerprint(first.context()), loop.Fingerprint(second.context())) << save_at;
    EXPECT_EQ(saved.time(), save_at);
  }
}

TEST_P(ContextTest, Line6ARunRestoredInItsOwnSimulatorGivesTheSameBits) {
  const Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(0.5);
  const Context saved = simulator.context();
  simulator.AdvanceTo(1.1);
  const std::string expected = loop.Fingerprint(simulator.context());
  simulator.context() = saved;
  simulator.AdvanceTo(1.1);
  EXPECT_EQ(loop.Fingerprint(simulator.context()), expected);
}

TEST_P(ContextTest, Line6ARunSavedByAMonitorAtATickOfTheControllerGoesOnWithTheSameBits) {
  const Loop loop;
  Simulator straight(*loop.diagram, {.integrator = GetParam()});
  std::vector<Context> saved;
  straight.AddMonitor([&](const Context& context) {
    const double tick = context.time() * 100.0;
    if (tick == std::round(tick) && std::fmod(tick, 10.0) == 0.0) saved.push_back(context);
    return true;
  });
  straight.AdvanceTo(1.0);
  ASSERT_EQ(saved.size(), 10u);
  for (const Context& context : saved) {
    Simulator resumed(*loop.diagram, context, {.integrator = GetParam()});
    resumed.AdvanceTo(1.0);
    EXPECT_EQ(loop.Fingerprint(resumed.context()), loop.Fingerprint(straight.context()))
        << context.time();
  }
}

TEST_P(ContextTest, Line6AdvancingFromTickToTickGivesTheBitsOfOneCall) {
  const Loop loop;
  Simulator whole(*loop.diagram, {.integrator = GetParam()});
  Simulator pieces(*loop.diagram, {.integrator = GetParam()});
  whole.AdvanceTo(1.0);
  for (int i = 1; i <= 100; ++i) pieces.AdvanceTo(i / 100.0);
  EXPECT_EQ(loop.Fingerprint(whole.context()), loop.Fingerprint(pieces.context()));
}

TEST_P(ContextTest, Line6ManyThreadsWithOneContextEachGiveTheSameBits) {
  const Loop loop;
  constexpr int kThreads = 8;
  std::vector<std::string> results(kThreads);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      Simulator simulator(*loop.diagram, {.integrator = GetParam()});
      simulator.AdvanceTo(0.7);
      results[i] = loop.Fingerprint(simulator.context());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(results, testing::Each(results[0]));
  Simulator alone(*loop.diagram, {.integrator = GetParam()});
  alone.AdvanceTo(0.7);
  EXPECT_EQ(loop.Fingerprint(alone.context()), results[0]);
}

TEST(ContextValueTest, CopiesAreIndependentAndAssignmentRestores) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Labeller>(Every{Period(1, 10)}));
  const auto in = diagram->GetInput<Vector>("in");
  const auto text = diagram->GetOutput<Label>("text");
  const auto held = diagram->GetOutput<Label>("held");
  Context one = diagram->MakeContext();
  in.Fix(one, Vec({1.0}));
  Context two = one;
  in.Fix(two, Vec({2.0}));
  two.SetTime(5.0);
  EXPECT_EQ(text.Eval(one).text, "1.000000");
  EXPECT_EQ(text.Eval(two).text, "2.000000");
  EXPECT_EQ(held.Eval(two).text, "start");
  EXPECT_EQ(one.time(), 0.0);
  one = two;
  EXPECT_EQ(text.Eval(one).text, "2.000000");
  EXPECT_EQ(one.time(), 5.0);
  const Context& self = one;
  one = self;
  EXPECT_EQ(text.Eval(one).text, "2.000000");
}

TEST(ContextValueTest, MovesCarryTheObjectsAlong) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Labeller>(Every{Period(1, 10)}));
  Context one = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(one, Vec({1.0}));
  Context two = std::move(one);
  EXPECT_EQ(diagram->GetOutput<Label>("text").Eval(two).text, "1.000000");
  Context three = diagram->MakeContext();
  three = std::move(two);
  EXPECT_EQ(diagram->GetOutput<Label>("text").Eval(three).text, "1.000000");
}

TEST(ContextValueTest, AssignmentAcrossDiagramsTakesTheOtherDiagramOver) {
  const auto labels = MakeDiagramOf(std::make_unique<blocks::Labeller>(Every{Period(1, 10)}));
  const auto maps = MakeDiagramOf(std::make_unique<blocks::Map>());
  Context context = labels->MakeContext();
  Context other = maps->MakeContext();
  maps->GetInput<Vector>("in").Fix(other, Vec({3.0}));
  context = other;
  EXPECT_EQ(maps->GetOutput<Vector>("out").Eval(context)[0], 3.0);
  EXPECT_THROW(labels->GetOutput<Label>("held").Eval(context), WiringError);
}

TEST(ContextValueTest, StatesAreReadAndSetByTheirHandles) {
  DiagramBuilder builder;
  const auto& counter = builder.Add<blocks::Counter>("counter", Every{Period(1, 10)});
  const auto& ode = builder.Add<blocks::Ode>("ode", 4.0, [](double, double, double) { return 0; });
  const auto& labeller = builder.Add<blocks::Labeller>("labeller", Every{Period(1, 10)});
  builder.Connect(counter.value, ode.in);
  builder.Connect(counter.value, labeller.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  EXPECT_EQ(ode.x.Get(context)[0], 4.0);
  EXPECT_EQ(labeller.state.Get(context).text, "start");
  counter.count.Set(context, Vec({7.0}));
  ode.x.Set(context, Vec({8.0}));
  labeller.state.Set(context, Label{"set"});
  EXPECT_EQ(counter.value.Eval(context)[0], 7.0);
  EXPECT_EQ(context.continuous_state()[0], 8.0);
  EXPECT_EQ(labeller.held.Eval(context).text, "set");
  context.SetContinuousState(Vec({9.0}));
  EXPECT_EQ(ode.out.Eval(context)[0], 9.0);
}

TEST(ContextValueTest, RefusesStatesOfAnotherLengthOrThatAreNotFinite) {
  DiagramBuilder builder;
  const auto& counter = builder.Add<blocks::Counter>("counter", Every{Period(1, 10)});
  const auto& ode = builder.Add<blocks::Ode>("ode", 4.0, [](double, double, double) { return 0; });
  builder.Connect(counter.value, ode.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  for (const auto& bad : {Vec({1.0, 2.0}), Vec({std::nan("")}), Vec({HUGE_VAL})}) {
    EXPECT_THROW(context.SetContinuousState(bad), ConfigError);
    EXPECT_THROW(ode.x.Set(context, bad), ConfigError);
    EXPECT_THROW(counter.count.Set(context, bad), ConfigError);
  }
  EXPECT_EQ(ode.x.Get(context)[0], 4.0);
}

}  // namespace context_test
}  // namespace oca
