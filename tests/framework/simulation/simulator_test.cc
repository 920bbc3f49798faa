// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/simulator.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/log.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace simulator_test {

using blocks::Vec;
using testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::unique_ptr<Diagram> CounterDiagram() {
  return MakeDiagramOf(std::make_unique<blocks::Counter>(Every{Period(1, 10)}));
}

double CountIn(const Diagram& diagram, const Context& context) {
  return diagram.GetOutput<Vector>("value").Eval(context)[0];
}

TEST(SimulatorTest, RefusesTimesThatAreNotFiniteOrPast) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(1.0);
  for (const double time : {kNan, kInfinity, -kInfinity, std::nextafter(1.0, 0.0)}) {
    EXPECT_THROW(simulator.AdvanceTo(time), ConfigError) << time;
  }
  EXPECT_EQ(simulator.context().time(), 1.0);
  EXPECT_TRUE(simulator.AdvanceTo(1.0));
  EXPECT_THROW(simulator.context().SetTime(kNan), ConfigError);
}

TEST(SimulatorTest, AMonitorEndsTheRunAfterItsStep) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  int others = 0;
  simulator.AddMonitor([](const Context& context) { return context.time() < 0.5; });
  simulator.AddMonitor([&](const Context&) { return ++others > 0; });
  EXPECT_FALSE(simulator.AdvanceTo(1.0));
  EXPECT_EQ(simulator.context().time(), 0.5);
  EXPECT_EQ(others, 5);  // the first one's refusal does not silence the second
  EXPECT_FALSE(simulator.AdvanceTo(1.0));
  EXPECT_EQ(simulator.context().time(), 0.6);
}

TEST(SimulatorTest, PublishesOfItsOwnKeepTheirRateAndSeeTheStateBeforeTheUpdate) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  std::vector<std::pair<double, double>> seen;
  simulator.AddPublish(Period(1, 5), [&](const Context& context) {
    seen.emplace_back(context.time(), CountIn(*diagram, context));
  });
  simulator.AdvanceTo(0.5);
  EXPECT_THAT(seen, ElementsAre(std::pair(0.0, 0.0), std::pair(0.2, 2.0), std::pair(0.4, 4.0)));
  EXPECT_EQ(simulator.statistics().publishes, 3);
  EXPECT_EQ(simulator.statistics().updates, 5);
}

TEST(SimulatorTest, RefusesAPublishWithoutAPeriodOrOnceItRuns) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  EXPECT_THROW(simulator.AddPublish(Period(), [](const Context&) {}), ConfigError);
  EXPECT_NO_THROW(simulator.AddPublish(Period(1, 3), [](const Context&) {}));
  simulator.Initialize();
  EXPECT_THROW(simulator.AddPublish(Period(1, 3), [](const Context&) {}), ConfigError);
}

TEST(SimulatorTest, ARefusedPublishLeavesTheClockAsItWas) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  EXPECT_THROW(simulator.AddPublish(Period(1, std::int64_t{1} << 60), [](const Context&) {}),
               ConfigError);
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(CountIn(*diagram, simulator.context()), 10.0);
}

TEST(SimulatorTest, RefusesAContextOfAnotherDiagram) {
  const auto one = CounterDiagram();
  const auto other = CounterDiagram();
  EXPECT_THROW(Simulator(*one, other->MakeContext()), WiringError);
  Simulator simulator(*one);
  simulator.context() = other->MakeContext();
  EXPECT_THROW(simulator.AdvanceTo(1.0), WiringError);
  simulator.context() = one->MakeContext();
  EXPECT_TRUE(simulator.AdvanceTo(1.0));
}

TEST(SimulatorTest, RefusesToInitializeBeforeEveryExportedInputIsFixed) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Delay>(Every{Period(1, 10)}));
  Simulator simulator(*diagram);
  try {
    simulator.Initialize();
    FAIL();
  } catch (const SimulationError& error) {
    EXPECT_STREQ(error.what(), "system.in at t = 0 s: the exported input has not been fixed");
  }
  diagram->GetInput<Vector>("in").Fix(simulator.context(), Vec({2.0}));
  EXPECT_TRUE(simulator.AdvanceTo(1.0));
}

TEST(SimulatorTest, AFreshContextStartsTheRunAnew) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  std::vector<double> published;
  simulator.AddPublish(Period(1, 2),
                       [&](const Context& context) { published.push_back(context.time()); });
  simulator.AdvanceTo(1.0);
  simulator.context() = diagram->MakeContext();
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(published, ElementsAre(0.0, 0.5, 1.0, 0.0, 0.5, 1.0));
  EXPECT_EQ(CountIn(*diagram, simulator.context()), 10.0);
}

TEST(SimulatorTest, ARestoredContextTakesEveryRateBackWithIt) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  std::vector<double> published;
  simulator.AddPublish(Period(1, 2),
                       [&](const Context& context) { published.push_back(context.time()); });
  simulator.AdvanceTo(1.0);
  const Context saved = simulator.context();
  simulator.AdvanceTo(2.0);
  simulator.context() = saved;
  simulator.AdvanceTo(2.0);
  EXPECT_THAT(published, ElementsAre(0.0, 0.5, 1.0, 1.5, 2.0, 1.5, 2.0));
  EXPECT_EQ(CountIn(*diagram, simulator.context()), 20.0);
}

TEST(SimulatorTest, AContextFromTheFutureDoesNotTurnTimeBack) {
  const auto diagram = CounterDiagram();
  Simulator ahead(*diagram);
  ahead.AdvanceTo(5.0);
  Simulator simulator(*diagram);
  std::vector<double> published;
  simulator.AddPublish(Period(1, 2),
                       [&](const Context& context) { published.push_back(context.time()); });
  simulator.AdvanceTo(1.0);
  simulator.context() = ahead.context();
  simulator.AdvanceTo(6.0);
  EXPECT_THAT(published, ElementsAre(0.0, 0.5, 1.0, 5.5, 6.0));
}

TEST(SimulatorTest, SettingTheTimeSkipsTheEventsBetweenAndNeverTurnsBack) {
  const auto diagram = CounterDiagram();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(1.0);
  simulator.context().SetTime(3.05);
  double last = 3.05;
  simulator.AddMonitor([&](const Context& context) {
    EXPECT_GE(context.time(), last);
    last = context.time();
    return true;
  });
  simulator.AdvanceTo(3.25);
  EXPECT_EQ(CountIn(*diagram, simulator.context()), 12.0);  // 3.1 and 3.2
  simulator.context().SetTime(0.15);
  last = 0.15;
  simulator.AdvanceTo(0.35);
  EXPECT_EQ(CountIn(*diagram, simulator.context()), 14.0);  // 0.2 and 0.3
}

/// Says its time to the log.
class Teller final : public System {
 public:
  Teller() { DeclarePublish<&Teller::Tell>(Every{Period(1, 2)}, kTime, kLog); }

 private:
  void Tell(double t, Log& log) const {
    if (log.enabled(LogLevel::kInfo)) log.Write(LogLevel::kInfo, t, "hello");
  }
};

struct Notebook : Log {
  bool enabled(LogLevel) const override { return true; }
  void Write(LogLevel, double time, std::string_view text) override {
    lines.push_back(std::to_string(time) + " " + std::string(text));
  }
  std::vector<std::string> lines;
};

TEST(SimulatorTest, TheLogReachesPublishEvents) {
  const auto diagram = MakeDiagramOf(std::make_unique<Teller>());
  Notebook notebook;
  Simulator simulator(*diagram);
  simulator.SetLog(&notebook);
  simulator.AdvanceTo(0.75);
  EXPECT_THAT(notebook.lines, ElementsAre("0.000000 hello", "0.500000 hello"));
  simulator.SetLog(nullptr);
  simulator.AdvanceTo(5.0);
  EXPECT_EQ(notebook.lines.size(), 2u);
}

/// Tells of each update of a state that is no Vector, which Initialize tries once for its size.
class LabelTeller final : public System {
 public:
  LabelTeller() : state_(DeclareDiscreteState("label", Label{})) {
    DeclareUpdate<&LabelTeller::Tell>(Every{Period(1, 2)}, Writes(state_), kTime, kLog);
  }

 private:
  void Tell(double t, Log& log, Label&) const { log.Write(LogLevel::kInfo, t, "update"); }
  const DiscreteState<Label> state_;
};

TEST(SimulatorTest, TheLogHearsOfAnUpdateOnceAndNotOfItsTrial) {
  const auto diagram = MakeDiagramOf(std::make_unique<LabelTeller>());
  Notebook notebook;
  Simulator simulator(*diagram);
  simulator.SetLog(&notebook);
  simulator.AdvanceTo(0.75);
  EXPECT_THAT(notebook.lines, ElementsAre("0.000000 update", "0.500000 update"));
}

TEST(SimulatorTest, TheLogStaysWithTheSimulatorWhenContextsComeAndGo) {
  const auto diagram = MakeDiagramOf(std::make_unique<Teller>());
  Context saved = diagram->MakeContext();
  {
    auto gone = std::make_unique<Notebook>();
    Simulator first(*diagram);
    first.SetLog(gone.get());
    first.AdvanceTo(1.0);
    saved = first.context();
  }
  Notebook notebook;
  Simulator second(*diagram, saved);  // must not write to the log that is gone
  second.AdvanceTo(1.5);
  second.SetLog(&notebook);
  second.context() = saved;
  second.AdvanceTo(2.0);
  EXPECT_THAT(notebook.lines, ElementsAre("1.500000 hello", "2.000000 hello"));
}

TEST(SimulatorTest, RefusesIntegratorOptionsOutOfBounds) {
  const auto diagram = CounterDiagram();
  for (const double bad : {0.0, -1.0, kNan}) {
    EXPECT_THROW(Simulator(*diagram, {.relative_tolerance = bad}), ConfigError);
    EXPECT_THROW(Simulator(*diagram, {.absolute_tolerance = bad}), ConfigError);
    EXPECT_THROW(Simulator(*diagram, {.max_step = bad}), ConfigError);
    EXPECT_THROW(Simulator(*diagram, {.fixed_step = bad}), ConfigError);
  }
  EXPECT_THROW(Simulator(*diagram, {.max_steps = 0}), ConfigError);
  EXPECT_THAT([&] { Simulator(*diagram, {.relative_tolerance = 2.0}); },
              testing::ThrowsMessage<ConfigError>("simulator.relative_tolerance: got 2; expected "
                                                  "in (0, 1]"));
  EXPECT_NO_THROW(Simulator(*diagram, {.relative_tolerance = 1.0}));
  EXPECT_THROW(Simulator(*diagram, {.tolerances = {{"system", {1e-6, 1e-9}}}}), ConfigError);
  EXPECT_NO_THROW(Simulator(*diagram, {.max_steps = 1}));
}

}  // namespace simulator_test
}  // namespace oca
