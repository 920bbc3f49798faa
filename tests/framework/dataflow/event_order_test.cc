// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, lines 1 to 3: what happens in one step, and in which order.
#include <gmock/gmock.h>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace event_order_test {

using blocks::Vec;
using testing::ElementsAre;

constexpr Every kSecond{};

Every Each(std::int64_t numerator, std::int64_t denominator = 1) {
  return {Period(numerator, denominator)};
}

/// Every stage appends what it reads of the stage before.
class Stages final : public System {
 public:
  Stages()
      : reset_(DeclareDiscreteState("reset", {1}, 0.0)),
        update_(DeclareDiscreteState("update", {1}, 0.0)),
        x_(DeclareContinuousState("x", {1}, 0.0)),
        x_out(DeclareStateOutput("x", x_)) {
    DeclareReset<&Stages::Reset>(Each(1), Writes(reset_), kTime, x_);
    DeclareUpdate<&Stages::Update>(Each(1), Writes(update_), kTime, reset_);
    DeclareDerivative<&Stages::Derive>(x_, update_);
    DeclarePublish<&Stages::Publish>(Each(1), kTime, x_, reset_, update_);
  }
  mutable std::vector<std::string> seen;

 private:
  void Note(const char* stage, double t, double value) const {
    seen.push_back(std::string(stage) + " t=" + std::to_string(static_cast<int>(t)) + " reads " +
                   std::to_string(static_cast<int>(std::lround(value))));
  }
  void Reset(double t, VectorView x, MutableVectorView next) const {
    Note("reset", t, x[0]);
    next[0] = x[0] + 1.0;
  }
  void Update(double t, VectorView reset, MutableVectorView next) const {
    Note("update", t, reset[0]);
    next[0] = 10.0 * reset[0];
  }
  void Derive(VectorView update, MutableVectorView derivative) const { derivative = update; }
  void Publish(double t, VectorView x, VectorView, VectorView) const { Note("publish", t, x[0]); }

  const DiscreteState<Vector> reset_, update_;
  const ContinuousState x_;

 public:
  const Output<Vector> x_out;
};

TEST(SimulatorContractTest, Line1EachStageReadsTheResultOfTheOneBefore) {
  DiagramBuilder builder;
  const auto& stages = builder.Add<Stages>("stages");
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = IntegratorKind::kFixedRk4, .fixed_step = 1.0});
  simulator.AddMonitor([&](const Context& context) {
    stages.seen.push_back("monitor reads " +
                          std::to_string(std::lround(stages.x_out.Eval(context)[0])));
    return true;
  });
  simulator.AdvanceTo(2.0);
  // By hand: x(0) = 0, reset 1, update 10, x(1) = 10, reset 11, update 110, x(2) = 120.
  EXPECT_THAT(stages.seen,
              ElementsAre("publish t=0 reads 0", "reset t=0 reads 0", "update t=0 reads 1",
                          "publish t=1 reads 10", "monitor reads 10", "reset t=1 reads 10",
                          "update t=1 reads 11", "publish t=2 reads 120", "monitor reads 120"));
}

/// Two values that trade places.
template <System::Stage kStage>
class Swap final : public System {
 public:
  Swap(double a, double b)
      : a_(DeclareDiscreteState("a", {1}, a)), b_(DeclareDiscreteState("b", {1}, b)) {
    DeclareStateOutput("a", a_);
    DeclareStateOutput("b", b_);
    if constexpr (kStage == Stage::kUpdate) {
      DeclareUpdate<&Swap::Copy>(Each(1), Writes(a_), b_);
      DeclareUpdate<&Swap::Copy>(Each(1), Writes(b_), a_);
    } else {
      DeclareReset<&Swap::Copy>(Each(1), Writes(a_), b_);
      DeclareReset<&Swap::Copy>(Each(1), Writes(b_), a_);
    }
  }

 private:
  void Copy(VectorView from, MutableVectorView next) const { next = from; }
  const DiscreteState<Vector> a_, b_;
};

template <System::Stage kStage>
void ExpectSwap() {
  const std::unique_ptr<Diagram> diagram = MakeDiagramOf(std::make_unique<Swap<kStage>>(3.0, 4.0));
  Simulator simulator(*diagram);
  for (int step = 0; step < 4; ++step) {
    const bool swapped = step % 2 == 1;
    EXPECT_EQ(diagram->GetOutput<Vector>("a").Eval(simulator.context())[0], swapped ? 4.0 : 3.0);
    EXPECT_EQ(diagram->GetOutput<Vector>("b").Eval(simulator.context())[0], swapped ? 3.0 : 4.0);
    simulator.AdvanceTo(step + 1.0);
  }
}

TEST(SimulatorContractTest, Line2UpdatesOfOneInstantSwapAAndB) {
  ExpectSwap<System::Stage::kUpdate>();
}

TEST(SimulatorContractTest, Line2ResetsOfOneInstantSwapAAndB) {
  ExpectSwap<System::Stage::kReset>();
}

TEST(SimulatorContractTest, Line2AChainOfDelaysMovesOneStepAnInstantWhateverTheOrderOfTheSystems) {
  for (const bool forward : {true, false}) {
    DiagramBuilder builder;
    const auto& first = builder.Add<blocks::Delay>(forward ? "a" : "z", Each(1));
    const auto& second = builder.Add<blocks::Delay>("m", Each(1));
    const auto& clock = builder.Add<blocks::Clock>("clock", [](double t) { return t + 1.0; });
    const blocks::Delay& from = forward ? first : second;
    const blocks::Delay& to = forward ? second : first;
    builder.Connect(clock.value, from.in);
    builder.Connect(from.out, to.in);
    const auto diagram = builder.Build();
    Simulator simulator(*diagram);
    simulator.AdvanceTo(3.0);
    // Updates ran at 0, 1, 2 with clock 1, 2, 3.
    EXPECT_EQ(from.out.Eval(simulator.context())[0], 3.0);
    EXPECT_EQ(to.out.Eval(simulator.context())[0], 2.0);
  }
}

struct Line3 {
  Line3() {
    DiagramBuilder builder;
    counter = &builder.Add<blocks::Counter>("counter", Each(1));
    const auto& printer = builder.Add<blocks::Printer>(
        "printer", Each(1), [this](double t, double value) { published.emplace_back(t, value); });
    builder.Connect(counter->value, printer.in);
    diagram = builder.Build();
  }
  const blocks::Counter* counter;
  std::vector<std::pair<double, double>> published;
  std::unique_ptr<Diagram> diagram;
};

TEST(SimulatorContractTest, Line3AdvanceToEndsWithUpdatesPendingAndPublishesDone) {
  Line3 bench;
  Simulator simulator(*bench.diagram);
  simulator.AdvanceTo(2.0);
  EXPECT_THAT(bench.counter->times, ElementsAre(0.0, 1.0));
  EXPECT_THAT(bench.published,
              ElementsAre(std::pair(0.0, 0.0), std::pair(1.0, 1.0), std::pair(2.0, 2.0)));
  EXPECT_EQ(bench.counter->value.Eval(simulator.context())[0], 2.0);
  // The pending update happens first thing in the next step, once.
  simulator.AdvanceTo(2.5);
  EXPECT_THAT(bench.counter->times, ElementsAre(0.0, 1.0, 2.0));
  EXPECT_EQ(bench.published.size(), 3u);
}

TEST(SimulatorContractTest, Line3AdvancingToThePresentDoesNothing) {
  Line3 bench;
  Simulator simulator(*bench.diagram);
  simulator.AdvanceTo(0.0);
  simulator.AdvanceTo(0.0);
  EXPECT_THAT(bench.counter->times, ElementsAre());
  EXPECT_EQ(bench.published.size(), 1u);
  simulator.AdvanceTo(1.0);
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(bench.counter->times, ElementsAre(0.0));
  EXPECT_EQ(bench.published.size(), 2u);
  EXPECT_EQ(simulator.statistics().steps, 1);
}

TEST(SimulatorContractTest, Line3InitializePublishesAndTheFirstUpdateBelongsToTheFirstStep) {
  Line3 bench;
  Simulator simulator(*bench.diagram);
  simulator.Initialize();
  EXPECT_THAT(bench.published, ElementsAre(std::pair(0.0, 0.0)));
  EXPECT_THAT(bench.counter->times, ElementsAre());
  simulator.AdvanceTo(0.25);
  EXPECT_THAT(bench.counter->times, ElementsAre(0.0));
}

/// Starts at what its input says.
class Start final : public System {
 public:
  Start()
      : in(DeclareInput<Vector>("in")),
        x(DeclareContinuousState("x", {1}, -1.0)),
        out(DeclareStateOutput("out", x)) {
    DeclareInitialization<&Start::Copy>(Writes(x), in);
    DeclareDerivative<&Start::Rest>(x);
  }

 private:
  void Copy(VectorView from, MutableVectorView next) const { next = from; }
  void Rest(MutableVectorView derivative) const { derivative.setZero(); }

 public:
  const Input<Vector> in;
  const ContinuousState x;
  const Output<Vector> out;
};

TEST(SimulatorContractTest, Line3InitializationEventsReadOneStateAndComeBeforeTheFirstPublish) {
  DiagramBuilder builder;
  const auto& first = builder.Add<Start>("first");
  const auto& second = builder.Add<Start>("second");
  const auto& source = builder.Add<blocks::Source>("source", Vec({8.0}));
  std::vector<double> published;
  const auto& printer = builder.Add<blocks::Printer>(
      "printer", Each(1), [&](double, double value) { published.push_back(value); });
  builder.Connect(source.value, first.in);
  builder.Connect(first.out, second.in);
  builder.Connect(first.out, printer.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.Initialize();
  EXPECT_THAT(published, ElementsAre(8.0));
  EXPECT_EQ(second.out.Eval(simulator.context())[0], -1.0);  // what first was, not what it became
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(second.out.Eval(simulator.context())[0], -1.0);
}

TEST(SimulatorContractTest, EventsWithoutAPeriodAreRefused) {
  EXPECT_THROW(blocks::Counter{kSecond}, ConfigError);
  EXPECT_THROW(blocks::Counter(Each(-1)), ConfigError);
  EXPECT_NO_THROW(blocks::Counter(Each(1)));
}

TEST(SimulatorContractTest, AnUpdateMayNotWriteContinuousStateNorTwoUpdatesOneState) {
  struct WritesContinuous : System {
    WritesContinuous() {
      const auto x = DeclareContinuousState("x", {1}, 0.0);
      DeclareUpdate<&WritesContinuous::Rest>(Each(1), Writes(x));
    }
    void Rest(MutableVectorView) const {}
  };
  struct WritesTwice : System {
    WritesTwice() {
      const auto x = DeclareDiscreteState("x", {1}, 0.0);
      DeclareUpdate<&WritesTwice::Rest>(Each(1), Writes(x));
      DeclareUpdate<&WritesTwice::Rest>(Each(2), Writes(x));
    }
    void Rest(MutableVectorView) const {}
  };
  EXPECT_THROW(WritesContinuous{}, WiringError);
  EXPECT_THROW(WritesTwice{}, WiringError);
}

}  // namespace event_order_test
}  // namespace oca
