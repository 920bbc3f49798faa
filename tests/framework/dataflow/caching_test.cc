// SPDX-License-Identifier: BSD-3-Clause
// What an output depends on is derived, and it is computed again only when that has changed.
#include <gtest/gtest.h>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace caching_test {

using blocks::Vec;

TEST(CachingTest, AnOutputThatReadsNothingIsComputedOnce) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({7.0}));
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  EXPECT_EQ(source.value.Eval(context)[0], 7.0);
  context.SetTime(1.0);
  EXPECT_EQ(source.value.Eval(context)[0], 7.0);
  EXPECT_EQ(source.calls, 1);
}

TEST(CachingTest, AHitCallsNothing) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(clock.value, map.in);
  const auto diagram = builder.Build();
  const Context context = diagram->MakeContext();
  for (int i = 0; i < 10; ++i) map.out.Eval(context);
  EXPECT_EQ(clock.calls, 1);
  EXPECT_EQ(map.calls, 1);
}

/// One output for each kind of source.
struct Bench {
  Bench() {
    DiagramBuilder builder;
    const auto add = [&](const char* name, const Output<Vector>& from) {
      const auto& map = builder.Add<blocks::Map>(name, [](double x) { return 2.0 * x; });
      builder.Connect(from, map.in);
      return &map;
    };
    const auto& clock = builder.Add<blocks::Clock>("clock");
    const auto& ode =
        builder.Add<blocks::Ode>("ode", 1.0, [](double, double, double) { return 1; });
    counter = &builder.Add<blocks::Counter>("counter", Every{Period(1, 10)});
    other = &builder.Add<blocks::Counter>("other", Every{Period(1, 7)});
    const auto& fixed = builder.Add<blocks::Map>("of_input", [](double x) { return 2.0 * x; });
    builder.ExportInput("u", fixed.in);
    builder.Connect(clock.value, ode.in);
    ode_state = ode.x;
    of_input = &fixed;
    of_time = add("of_time", clock.value);
    of_continuous = add("of_continuous", ode.out);
    of_counter = add("of_counter", counter->value);
    of_other = add("of_other", other->value);
    diagram = builder.Build();
  }
  std::vector<int> CallsAfterEvaluatingAll(const Context& context) const {
    std::vector<int> calls;
    for (const auto* map : {of_time, of_continuous, of_counter, of_other, of_input}) {
      const int before = map->calls;
      map->out.Eval(context);
      calls.push_back(map->calls - before);
    }
    return calls;
  }
  const blocks::Counter *counter, *other;
  const blocks::Map *of_time, *of_continuous, *of_counter, *of_other, *of_input;
  ContinuousState ode_state;
  std::unique_ptr<Diagram> diagram;
};

using Calls = std::vector<int>;  // of time, continuous, counter, other, input

TEST(CachingTest, EachSourceMakesOnlyItsOwnOutputsStale) {
  const Bench bench;
  Context context = bench.diagram->MakeContext();
  const auto input = bench.diagram->GetInput<Vector>("u");
  input.Fix(context, Vec({1.0}));
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{1, 1, 1, 1, 1}));
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{0, 0, 0, 0, 0}));
  context.SetTime(0.5);
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{1, 0, 0, 0, 0}));
  bench.ode_state.Set(context, Vec({3.0}));
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{0, 1, 0, 0, 0}));
  bench.counter->count.Set(context, Vec({4.0}));
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{0, 0, 1, 0, 0}));
  bench.other->count.Set(context, Vec({4.0}));
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{0, 0, 0, 1, 0}));
  input.Fix(context, Vec({5.0}));
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{0, 0, 0, 0, 1}));
  EXPECT_EQ(bench.of_input->out.Eval(context)[0], 10.0);
  EXPECT_EQ(bench.of_continuous->out.Eval(context)[0], 6.0);
}

TEST(CachingTest, TheTimeItAlreadyIsChangesNothing) {
  const Bench bench;
  Context context = bench.diagram->MakeContext();
  bench.diagram->GetInput<Vector>("u").Fix(context, Vec({1.0}));
  context.SetTime(0.5);
  bench.CallsAfterEvaluatingAll(context);
  context.SetTime(0.5);
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{0, 0, 0, 0, 0}));
}

TEST(CachingTest, SeveralChangesCostOneCalculation) {
  const Bench bench;
  Context context = bench.diagram->MakeContext();
  bench.diagram->GetInput<Vector>("u").Fix(context, Vec({1.0}));
  bench.CallsAfterEvaluatingAll(context);
  for (int i = 0; i < 5; ++i) context.SetTime(1.0 + i);
  EXPECT_EQ(bench.CallsAfterEvaluatingAll(context), (Calls{1, 0, 0, 0, 0}));
}

TEST(CachingTest, WhatNobodyReadsIsNeverComputed) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto& idle = builder.Add<blocks::Map>("idle");
  builder.Add<blocks::Counter>("counter", Every{Period(1, 100)});
  builder.Connect(clock.value, idle.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(idle.calls, 0);
  EXPECT_EQ(clock.calls, 0);
}

TEST(CachingTest, ADiamondIsComputedOnceOnEachSide) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto& left = builder.Add<blocks::Map>("left", [](double x) { return x + 1.0; });
  const auto& right = builder.Add<blocks::Map>("right", [](double x) { return x * 10.0; });
  const auto& sum = builder.Add<blocks::Sum>("sum");
  builder.Connect(clock.value, left.in);
  builder.Connect(clock.value, right.in);
  builder.Connect(left.out, sum.in0);
  builder.Connect(right.out, sum.in1);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  context.SetTime(2.0);
  EXPECT_EQ(sum.out.Eval(context)[0], 23.0);
  EXPECT_EQ(clock.calls, 1);
  EXPECT_EQ(left.calls, 1);
  EXPECT_EQ(right.calls, 1);
}

TEST(CachingTest, AStateThatIsWrittenWithTheSameBitsMakesNothingStale) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({0.0}));
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 10)});
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(source.value, delay.in);
  builder.Connect(delay.out, map.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  map.out.Eval(simulator.context());
  simulator.AdvanceTo(1.05);
  map.out.Eval(simulator.context());
  EXPECT_EQ(map.calls, 1);
}

TEST(CachingTest, ACopiedContextKeepsItsCacheAndGoesItsOwnWay) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto diagram = builder.Build();
  Context one = diagram->MakeContext();
  one.SetTime(1.0);
  clock.value.Eval(one);
  Context two = one;
  EXPECT_EQ(clock.value.Eval(two)[0], 1.0);
  EXPECT_EQ(clock.calls, 1);
  two.SetTime(2.0);
  EXPECT_EQ(clock.value.Eval(two)[0], 2.0);
  EXPECT_EQ(clock.value.Eval(one)[0], 1.0);
  EXPECT_EQ(clock.calls, 2);
}

TEST(CachingTest, AnExportedInputThatNobodyFixedIsNamedWhateverItsType) {
  const auto map = MakeDiagramOf(std::make_unique<blocks::Map>([](double) { return 0.0; }));
  const auto sink = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  const auto text_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const SimulationError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(text_of([&] { map->GetOutput<Vector>("out").Eval(map->MakeContext()); }),
            "system.in at t = 0 s: the exported input has not been fixed");
  EXPECT_EQ(text_of([&] { sink->GetOutput<Label>("out").Eval(sink->MakeContext()); }),
            "system.in at t = 0 s: the exported input has not been fixed");
}

}  // namespace caching_test
}  // namespace oca
