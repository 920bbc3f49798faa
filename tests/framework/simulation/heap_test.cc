// SPDX-License-Identifier: BSD-3-Clause
// After Initialize nothing takes memory from the heap, SUNDIALS included: every malloc is counted,
// which is where operator new takes its memory too.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>

#include "oca/framework/dataflow/function.h"
#include "oca/framework/simulation/signal_log.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/allocation_count.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca {
namespace heap_test {

class HeapTest : public testing::TestWithParam<IntegratorKind> {
 protected:
  void SetUp() override {
    if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  }
};
INSTANTIATE_TEST_SUITE_P(Integrators, HeapTest, testing::ValuesIn(kAllIntegrators), NameOfKind);

TEST(HeapCounterTest, SeesWhatNewMallocAndCallocTake) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const std::int64_t before = AllocationCount();
  const Eigen::VectorXd vector = Eigen::VectorXd::Zero(100);
  EXPECT_EQ(AllocationCount(), before + 1) << vector.size();
  void* volatile block = std::calloc(10, 10);
  EXPECT_EQ(AllocationCount(), before + 2);
  std::free(block);
  ::operator delete(::operator new(64, std::align_val_t(64)), std::align_val_t(64));
  EXPECT_EQ(AllocationCount(), before + 3);
}

/// A sampled loop around a stiff lag, two more rates, a publish and a reset.
struct Loop {
  Loop() {
    DiagramBuilder builder;
    const auto& lag = builder.Add<blocks::Ode>(
        "lag", 0.2, [](double t, double x, double u) { return 40.0 * (std::sin(t) - x) + u; });
    const auto& other = builder.Add<blocks::Ode>(
        "other", 0.2, [](double, double x, double u) { return u * u - std::sin(x); });
    const auto& control = builder.Add<blocks::Map>("control", [](double x) { return -1.5 * x; });
    const auto& hold = builder.Add<blocks::Delay>("hold", Every{Period(1, 100)});
    const auto& slow = builder.Add<blocks::Delay>("slow", Every{Period(1, 30)});
    const auto& printer = builder.Add<blocks::Printer>("printer", Every{Period(1, 60)},
                                                       [this](double, double x) { last = x; });
    builder.Connect(lag.out, control.in);
    builder.Connect(control.out, hold.in);
    builder.Connect(hold.out, lag.in);
    builder.Connect(lag.out, slow.in);
    builder.Connect(slow.out, other.in);
    builder.Connect(other.out, printer.in);
    diagram = builder.Build();
  }
  double last{0.0};
  std::unique_ptr<Diagram> diagram;
};

TEST_P(HeapTest, AThousandTicksAfterInitializeTakeNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  int monitored = 0;
  simulator.AddMonitor([&](const Context&) { return ++monitored > 0; });
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  for (int tick = 1; tick <= 1000; ++tick) simulator.AdvanceTo(tick / 100.0);
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_GT(monitored, 1000);
  EXPECT_NE(loop.last, 0.0);
}

TEST_P(HeapTest, AnUnbrokenRunTakesNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(10.0);
  EXPECT_EQ(AllocationCount() - before, 0);
}

TEST_P(HeapTest, ASignalLogThatIsFullTakesNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  const SignalLog log(simulator, {loop.diagram->FindSystem("lag")->FindOutput("out")},
                      Period(1, 1000), 100);
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_EQ(log.overwritten(), 901);
}

TEST_P(HeapTest, SavingIntoAndRestoringFromAContextTakesNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  simulator.Initialize();
  Context saved = simulator.context();
  const std::int64_t before = AllocationCount();
  for (int i = 1; i <= 10; ++i) {
    simulator.AdvanceTo(0.1 * i);
    saved = simulator.context();
    simulator.AdvanceTo(0.1 * i + 0.05);
    simulator.context() = saved;
  }
  EXPECT_EQ(AllocationCount() - before, 0);
}

TEST_P(HeapTest, BlocksGivenAsLambdasTakeNothing) {
  DiagramBuilder builder;
  const System& clock = builder.AddSystem(
      "clock", MakeBlock({.output = {"out", 2}},
                         [](double t, MutableVectorView out) { out << t, std::sin(t); }));
  const System& norm =
      builder.AddSystem("norm", MakeBlock({.inputs = {{"in"}}, .output = {"out", 1}},
                                          [](VectorView in) { return in.norm(); }));
  const System& all = builder.AddSystem(
      "all", MakeBlock({.inputs = {{"a", 1}}, .output = {"out", 1}}, {Period(1, 100), 0.0},
                       [](const VectorInputs& in, MutableVectorView x) { x += in[0]; }));
  builder.ConnectPorts(clock.FindOutput("out"), norm.FindInput("in"));
  builder.ConnectPorts(norm.FindOutput("out"), all.FindInput("a"));
  builder.ExportOutput("out", all.FindOutput("out"));
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(3.0);
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_GT(diagram->GetOutput<Vector>("out").Eval(simulator.context())[0], 100.0);
}

/// Bounces between two walls under a pull; each wall is a witness.
class Bouncer final : public System {
 public:
  Bouncer()
      : x_(DeclareContinuousState("x", {2}, blocks::Vec({0.1, 1.0}))),
        count(DeclareDiscreteState("count", {1}, 0.0)) {
    DeclareDerivative<&Bouncer::Derive>(x_, x_);
    const Witness low = DeclareWitness<&Bouncer::Low>("low", Direction::kFalling, x_);
    const Witness high = DeclareWitness<&Bouncer::High>("high", Direction::kRising, x_);
    DeclareReset<&Bouncer::Turn>(When{low}, Writes(x_, count), x_, count);
    DeclareReset<&Bouncer::Turn>(When{high}, Writes(x_, count), x_, count);
  }

 private:
  void Derive(VectorView now, MutableVectorView derivative) const {
    derivative << now[1], -std::sin(now[0]);
  }
  double Low(VectorView now) const { return now[0]; }
  double High(VectorView now) const { return now[0] - 0.2; }
  void Turn(VectorView now, VectorView turns, MutableVectorView next,
            MutableVectorView more) const {
    next[1] = -now[1];
    more[0] = turns[0] + 1.0;
  }
  const ContinuousState x_;

 public:
  const DiscreteState<Vector> count;
};

TEST_P(HeapTest, WitnessesAndTheirResetsTakeNothing) {
  DiagramBuilder builder;
  const auto& bouncer = builder.Add<Bouncer>("bouncer");
  const auto& source = builder.Add<blocks::Source>("source", blocks::Vec({1.0}));
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 50)});
  builder.Connect(source.value, delay.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(10.0);
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_GT(bouncer.count.Get(simulator.context())[0], 20.0);
}

TEST(HeapObjectTest, AssigningAContextWithObjectsReusesTheirCapacity) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  const auto in = diagram->GetInput<Label>("in");
  const auto out = diagram->GetOutput<Label>("out");
  Context one = diagram->MakeContext();
  in.Fix(one, Label{std::string(100, 'a')});
  out.Eval(one);
  Context two = one;
  const Label other{std::string(90, 'b')};
  const std::int64_t before = AllocationCount();
  in.Fix(one, other);
  out.Eval(one);
  two = one;
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_EQ(out.Eval(two).text, other.text);
}

}  // namespace heap_test
}  // namespace oca
