// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/control_loop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/log.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/allocation_count.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace control_loop_test {

using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StrEq;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Period kMillisecond(1, 1000);

/// in -> double -> hold (10 ms) -> out, and what the rest of the diagram counts.
struct Sampled {
  explicit Sampled(Every every = {Period(1, 100)}) {
    DiagramBuilder builder;
    const auto& twice = builder.Add<blocks::Map>("twice", [this](double x) {
      if (broken) throw std::runtime_error("broken on purpose");
      return x > 1e100 ? kNan : 2.0 * x;
    });
    const auto& hold = builder.Add<blocks::Delay>("hold", every, Vec({0.0, 0.0}));
    counter = &builder.Add<blocks::Counter>("counter", Every{Period(3, 1000), Period(1, 1000)});
    builder.Connect(twice.out, hold.in);
    builder.ExportInput("in", twice.in);
    builder.ExportOutput("out", hold.out);
    builder.ExportOutput("now", twice.out);
    diagram = builder.Build();
    in = diagram->GetInput<Vector>("in");
    out = diagram->GetOutput<Vector>("out");
    now = diagram->GetOutput<Vector>("now");
  }
  bool broken{false};
  const blocks::Counter* counter;
  std::unique_ptr<Diagram> diagram;
  Input<Vector> in;
  Output<Vector> out, now;
};

struct Looped : Sampled {
  Looped() : loop(*diagram, kMillisecond) {
    loop.Watch(out);
    loop.Watch(now);
    EXPECT_TRUE(loop.Set(in, Vec({0.0, 0.0})).ok());
    loop.Initialize();
  }
  ControlLoop loop;
};

TEST(ControlLoopTest, GivesTheBitsOfTheSimulator) {
  Looped looped;
  Sampled simulated;
  Simulator simulator(*simulated.diagram);
  for (int k = 0; k < 1000; ++k) {
    const Eigen::VectorXd u = Vec({std::sin(0.1 * k), std::cos(0.3 * k)});
    ASSERT_TRUE(looped.loop.Set(looped.in, u).ok());
    ASSERT_TRUE(looped.loop.Tick().ok());
    simulated.in.Fix(simulator.context(), u);
    simulator.AdvanceTo((k + 1) / 1000.0);
    ASSERT_EQ(looped.loop.Get(looped.out), simulated.out.Eval(simulator.context())) << k;
  }
  EXPECT_EQ(looped.counter->times, simulated.counter->times);
}

TEST(ControlLoopTest, RunsEventsAtTheirOwnPeriodsAndOffsets) {
  Looped looped;
  for (int k = 0; k < 9; ++k) ASSERT_TRUE(looped.loop.Tick().ok());
  EXPECT_THAT(looped.counter->times, ElementsAre(0.001, 0.004, 0.007));
  EXPECT_EQ(looped.loop.time(), 0.008);
  EXPECT_EQ(looped.loop.ticks(), 9);
}

TEST(ControlLoopTest, AnUpdateReadsTheInputOfItsTickAndTheWatchedOutputShowsItAtOnce) {
  Looped looped;
  EXPECT_TRUE(looped.loop.Set(looped.in, Vec({1.0, 2.0})).ok());
  ASSERT_TRUE(looped.loop.Tick().ok());
  EXPECT_EQ(looped.loop.Get(looped.out), Vec({2.0, 4.0}));
  EXPECT_TRUE(looped.loop.Set(looped.in, Vec({3.0, 4.0})).ok());
  for (int k = 1; k < 10; ++k) {
    ASSERT_TRUE(looped.loop.Tick().ok());
    EXPECT_EQ(looped.loop.Get(looped.out), Vec({2.0, 4.0})) << "held until 10 ms";
    EXPECT_EQ(looped.loop.Get(looped.now), Vec({6.0, 8.0}));
  }
  ASSERT_TRUE(looped.loop.Tick().ok());
  EXPECT_EQ(looped.loop.Get(looped.out), Vec({6.0, 8.0}));
}

TEST(ControlLoopTest, PublishesSeeTheStateBeforeTheUpdatesOfTheirInstant) {
  DiagramBuilder builder;
  std::vector<double> seen;
  const auto& counter = builder.Add<blocks::Counter>("counter", Every{kMillisecond});
  const auto& printer = builder.Add<blocks::Printer>("printer", Every{Period(2, 1000)},
                                                     [&](double, double x) { seen.push_back(x); });
  builder.Connect(counter.value, printer.in);
  const auto diagram = builder.Build();
  ControlLoop loop(*diagram, kMillisecond);
  loop.Initialize();
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(loop.Tick().ok());
  EXPECT_THAT(seen, ElementsAre(0.0, 2.0, 4.0));
}

TEST(ControlLoopTest, ATickThatFailsIsNamedKeepsTheStateAndIsMadeUpForByTheNext) {
  Looped looped;
  EXPECT_TRUE(looped.loop.Set(looped.in, Vec({1.0, 1.0})).ok());
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(looped.loop.Tick().ok());
  looped.broken = true;
  EXPECT_TRUE(looped.loop.Set(looped.in, Vec({5.0, 5.0})).ok());
  const Status status = looped.loop.Tick();
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(status.system(), StrEq("twice"));
  EXPECT_THAT(status.port(), StrEq("out"));
  EXPECT_EQ(status.time(), 0.01);
  EXPECT_THAT(status.message(), StrEq("twice.out at t = 0.01 s: broken on purpose"));
  EXPECT_EQ(looped.out.Eval(looped.loop.context()), Vec({2.0, 2.0}));
  EXPECT_EQ(looped.counter->times.back(), 0.007);
  looped.broken = false;
  ASSERT_TRUE(looped.loop.Tick().ok());
  EXPECT_EQ(looped.loop.time(), 0.011);
  EXPECT_EQ(looped.loop.Get(looped.out), Vec({10.0, 10.0})) << "the update of 10 ms";
  for (int k = 12; k <= 20; ++k) ASSERT_TRUE(looped.loop.Tick().ok());
  // The counter's update of 10 ms came one tick late, those after it in time.
  EXPECT_THAT(looped.counter->times, ElementsAre(0.001, 0.004, 0.007, 0.011, 0.013, 0.016, 0.019));
}

TEST(ControlLoopTest, ANumberThatIsNotFiniteIsNamed) {
  Looped looped;
  EXPECT_TRUE(looped.loop.Set(looped.in, Vec({1e200, 0.0})).ok());
  const Status status = looped.loop.Tick();
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(status.message(), HasSubstr("twice.out at t = 0 s: the value is not finite"));
}

TEST(ControlLoopTest, AValueThatIsRefusedLeavesTheLastOne) {
  Looped looped;
  EXPECT_TRUE(looped.loop.Set(looped.in, Vec({1.0, 2.0})).ok());
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL}) {
    const Status status = looped.loop.Set(looped.in, Vec({0.0, bad}));
    EXPECT_FALSE(status.ok());
    EXPECT_THAT(status.port(), StrEq("in"));
    EXPECT_THAT(status.message(), HasSubstr("expected finite numbers"));
  }
  EXPECT_THAT(looped.loop.Set(looped.in, Vec({0.0})).message(),
              StrEq("input in at t = 0 s: got 1 numbers; expected 2"));
  ASSERT_TRUE(looped.loop.Tick().ok());
  EXPECT_EQ(looped.loop.Get(looped.now), Vec({2.0, 4.0}));
}

TEST(ControlLoopTest, AnInputThatIsNoneOfTheDiagramIsRefused) {
  Looped looped;
  const Sampled other;
  EXPECT_THAT(looped.loop.Set(other.in, Vec({0.0, 0.0})).message(),
              HasSubstr("one that the diagram does not export"));
  EXPECT_FALSE(looped.loop.Set(Input<Vector>{}, Vec({0.0, 0.0})).ok());
  EXPECT_THROW(looped.loop.Watch(other.out), WiringError);
}

TEST(ControlLoopTest, ObjectsAreSetAndReadToo) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  const auto in = diagram->GetInput<Label>("in");
  const auto out = diagram->GetOutput<Label>("out");
  ControlLoop loop(*diagram, kMillisecond);
  loop.Watch(out);
  EXPECT_TRUE(loop.Set(in, Label{"first"}).ok());
  loop.Initialize();
  EXPECT_TRUE(loop.Set(in, Label{"second"}).ok());
  EXPECT_FALSE(loop.Set(in, Label{"nan"}).ok());
  ASSERT_TRUE(loop.Tick().ok());
  EXPECT_EQ(loop.Get(out).text, "second");
}

TEST(ControlLoopTest, MustBeInitializedOnceAndWithAllInputs) {
  const Sampled sampled;
  ControlLoop loop(*sampled.diagram, kMillisecond);
  EXPECT_THAT(loop.Tick().message(), HasSubstr("before Initialize"));
  EXPECT_THROW(loop.Initialize(), SimulationError);
  EXPECT_TRUE(loop.Set(sampled.in, Vec({0.0, 0.0})).ok());
  loop.Initialize();
  EXPECT_THROW(loop.Initialize(), ConfigError);
  EXPECT_TRUE(loop.Tick().ok());
  EXPECT_EQ(loop.time(), 0.0) << "the first tick is that of time 0";
}

TEST(ControlLoopTest, RefusesPeriodsThatAreNotMultiplesOfItsOwn) {
  const auto text_of = [](Every every, const Period& period) -> std::string {
    const auto diagram = MakeDiagramOf(std::make_unique<blocks::Counter>(every));
    try {
      const ControlLoop loop(*diagram, period);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(text_of({Period(1, 100)}, kMillisecond), "");
  EXPECT_EQ(text_of({Period(1, 1000)}, kMillisecond), "");
  EXPECT_EQ(text_of({Period(2, 60)}, Period(1, 60)), "");
  EXPECT_EQ(text_of({Period(1, 60)}, kMillisecond),
            "control loop: system: events; got them every 1/60 s; expected whole multiples of "
            "0.001 s");
  EXPECT_THAT(text_of({Period(1, 1000), Period(1, 2000)}, kMillisecond), HasSubstr("0.0005 s"));
  EXPECT_THAT(text_of({Period(1, 2000)}, kMillisecond), HasSubstr("0.0005 s"));
  EXPECT_THAT(text_of({Period(1, 100)}, Period()), HasSubstr("expected > 0 s"));
  EXPECT_THAT(text_of({Period(1, 100)}, Period(-1, 100)), HasSubstr("expected > 0 s"));
  EXPECT_THAT(text_of({Period(std::int64_t{1} << 40, 1)}, kMillisecond), HasSubstr("multiples"));
}

/// Takes angles between -1 and 1, and refuses a Label that says nan.
class Choosy final : public System {
 public:
  Choosy() : out(DeclareOutput<Vector, &Choosy::Calc>("out", {2}, angles)) {}

 private:
  static PortSpec Spec() {
    const Plausible plausible{
        Vec({-1.0, -1.0}), Vec({1.0, 2.0}), {"joint 'a'", "joint 'b'"}, "by design"};
    return {2, Unit::Any(), std::make_shared<const Plausible>(plausible)};
  }
  void Calc(VectorView in, MutableVectorView value) const { value = in; }

 public:
  const Input<Vector> angles{DeclareInput<Vector>("angles", Spec())};
  const Output<Vector> out;
};

TEST(ControlLoopTest, RefusesWhatAPortCannotBeByNameAndKeepsTheLastValue) {
  DiagramBuilder builder;
  const auto& twice = builder.Add<blocks::Map>("twice", [](double x) { return 2.0 * x; });
  const auto& choosy = builder.Add<Choosy>("choosy");
  builder.ExportInput("q", choosy.angles);
  builder.ExportInput("q", twice.in);
  builder.ExportOutput("out", choosy.out);
  const auto diagram = builder.Build();
  ControlLoop loop(*diagram, kMillisecond);
  const auto q = diagram->GetInput<Vector>("q");
  const auto out = diagram->GetOutput<Vector>("out");
  loop.Watch(out);
  EXPECT_TRUE(loop.Set(q, Vec({-1.0, 2.0})).ok());
  loop.Initialize();
  const Status status = loop.Set(q, Vec({0.0, 2.5}));
  EXPECT_THAT(status.port(), StrEq("q"));
  EXPECT_THAT(status.message(),
              StrEq("input q at t = 0 s: joint 'b'; got 2.5; expected -1 to 2, by design"));
  EXPECT_FALSE(loop.Set(q, Vec({-1.0001, 0.0})).ok());
  ASSERT_TRUE(loop.Tick().ok());
  EXPECT_EQ(loop.Get(out), Vec({-1.0, 2.0}));
  Context context = diagram->MakeContext();
  EXPECT_THROW(q.Fix(context, Vec({0.0, 2.5})), ConfigError);
}

TEST(ControlLoopTest, RefusesAStartThatAPortCannotBe) {
  DiagramBuilder builder;
  const auto& hold = builder.Add<blocks::Delay>("hold", Every{kMillisecond}, Vec({0.0, 7.0}));
  const auto& choosy = builder.Add<Choosy>("choosy");
  builder.Connect(hold.out, choosy.angles);
  builder.ExportInput("in", hold.in);
  const auto diagram = builder.Build();
  ControlLoop loop(*diagram, kMillisecond);
  ASSERT_TRUE(loop.Set(diagram->GetInput<Vector>("in"), Vec({0.0, 0.0})).ok());
  try {
    loop.Initialize();
    FAIL();
  } catch (const SimulationError& error) {
    EXPECT_THAT(error.what(), StrEq("hold.out at t = 0 s: joint 'b'; got 7; expected -1 to 2, by "
                                    "design"));
  }
}

/// A guard on the time.
class Alarm final : public System {
 public:
  Alarm() { DeclareWitness<&Alarm::Left>("left", Direction::kBoth, kTime); }

 private:
  double Left(double t) const { return t - 1.0; }
};

TEST(ControlLoopTest, RefusesWhatOnlyASimulatorCanAdvance) {
  const auto text_of = [](std::unique_ptr<System> system) -> std::string {
    const auto diagram = MakeDiagramOf(std::move(system));
    try {
      const ControlLoop loop(*diagram, kMillisecond);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(
      text_of(std::make_unique<blocks::Ode>(0.0, [](double, double, double) { return 0.; })),
      HasSubstr("system.x; got a continuous state"));
  EXPECT_THAT(text_of(std::make_unique<Alarm>()), HasSubstr("system.left; got a witness function"));
}

TEST(ControlLoopHeapTest, TicksAndRefusedValuesTakeNothing) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Looped looped;
  looped.counter->times.reserve(100000);
  const Eigen::VectorXd u = Vec({1.0, 2.0}), bad = Vec({1.0, kNan}), longer = Vec({1.0, 2.0, 3.0});
  int refused = 0;
  const std::int64_t before = AllocationCount();
  for (int k = 0; k < 10000; ++k) {
    refused += !looped.loop.Set(looped.in, bad).ok();
    refused += !looped.loop.Set(looped.in, longer).ok();
    refused += !looped.loop.Set(looped.in, u).ok();
    refused += !looped.loop.Tick().ok();
  }
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_EQ(refused, 20000);
}

TEST(StatusTest, ATextThatIsTooLongEndsInDots) {
  const Status status =
      Status::Failure(std::string(63, 'a'), std::string(32, 'b'), 1.0, std::string(1000, 'c'));
  EXPECT_EQ(status.system(), std::string(63, 'a'));
  EXPECT_EQ(status.port(), std::string(28, 'b') + "...");
  EXPECT_EQ(status.message(), std::string(252, 'c') + "...");
}

TEST(StatusTest, TellsAnyException) {
  const auto of = [](auto error) {
    try {
      throw error;
    } catch (...) {
      return Status::OfCurrentException(2.0);
    }
  };
  const Status located = of(SimulationError("arm", "q", 1.5, "lost"));
  EXPECT_THAT(located.system(), StrEq("arm"));
  EXPECT_THAT(located.port(), StrEq("q"));
  EXPECT_EQ(located.time(), 1.5);
  EXPECT_THAT(located.message(), StrEq("arm.q at t = 1.5 s: lost"));
  EXPECT_THAT(of(std::runtime_error("other")).message(), StrEq("other"));
  EXPECT_EQ(of(std::runtime_error("other")).time(), 2.0);
  EXPECT_THAT(of(7).message(), HasSubstr("unknown type"));
  EXPECT_TRUE(Status().ok());
}

}  // namespace control_loop_test
}  // namespace oca
