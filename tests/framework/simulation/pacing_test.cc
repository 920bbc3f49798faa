// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, line 9: wall-clock pacing, overruns counted and the worst one kept.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>

#include "oca/framework/dataflow/profile.h"
#include "oca/framework/simulation/pacer.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace pacing_test {

using testing::DoubleNear;
using testing::ElementsAre;

/// A clock that moves only when it is slept on or pushed.
class HandClock final : public WallClock {
 public:
  double Now() override { return now; }
  void SleepUntil(double time) override {
    slept_until.push_back(time);
    now = std::max(now, time);
  }
  double now{100.0};
  std::vector<double> slept_until;
};

/// A simulator that ticks every 0.1 s, under a clock moved by hand.
struct Ticking {
  Ticking()
      : diagram(MakeDiagramOf(std::make_unique<blocks::Counter>(Every{Period(1, 10)}))),
        simulator(*diagram) {}
  HandClock clock;
  std::unique_ptr<Diagram> diagram;
  Simulator simulator;
};

TEST(PacingTest, Line9EachStepEndsWhenItIsDue) {
  Ticking ticking;
  ticking.simulator.SetRealtimeFactor(1.0, ticking.clock);
  ticking.simulator.AdvanceTo(0.3);
  EXPECT_THAT(ticking.clock.slept_until, ElementsAre(100.1, 100.2, 100.3));
  EXPECT_EQ(ticking.simulator.statistics().overruns, 0);
}

TEST(PacingTest, Line9AFactorOfTwoTakesHalfTheTime) {
  Ticking ticking;
  ticking.simulator.SetRealtimeFactor(2.0, ticking.clock);
  ticking.simulator.AdvanceTo(0.3);
  EXPECT_THAT(ticking.clock.slept_until, ElementsAre(100.05, 100.1, 100.15));
}

TEST(PacingTest, Line9AFactorOfZeroNeverWaits) {
  Ticking ticking;
  ticking.simulator.SetRealtimeFactor(1.0, ticking.clock);
  ticking.simulator.SetRealtimeFactor(0.0, ticking.clock);
  ticking.simulator.AdvanceTo(0.3);
  EXPECT_THAT(ticking.clock.slept_until, ElementsAre());
}

TEST(PacingTest, Line9OverrunsAreCountedTheWorstIsKeptAndTheScheduleStays) {
  Ticking ticking;
  ticking.simulator.SetRealtimeFactor(1.0, ticking.clock);
  int step = 0;
  ticking.simulator.AddMonitor([&](const Context&) {
    // The second step hangs for 0.25 s: the third and the fourth are late.
    if (++step == 2) ticking.clock.now += 0.25;
    return true;
  });
  ticking.simulator.AdvanceTo(0.6);
  EXPECT_THAT(ticking.clock.slept_until,
              ElementsAre(100.1, 100.2, DoubleNear(100.5, 1e-12), DoubleNear(100.6, 1e-12)));
  EXPECT_EQ(ticking.simulator.statistics().overruns, 2);
  EXPECT_NEAR(ticking.simulator.statistics().worst_overrun, 0.15, 1e-12);
}

TEST(PacingTest, Line9ALaterCallKeepsTheScheduleAndAContextSetElsewhereStartsAnother) {
  Ticking ticking;
  ticking.simulator.SetRealtimeFactor(1.0, ticking.clock);
  ticking.simulator.AdvanceTo(0.1);
  ticking.clock.now += 0.04;
  ticking.simulator.AdvanceTo(0.2);
  EXPECT_THAT(ticking.clock.slept_until, ElementsAre(100.1, 100.2));
  ticking.simulator.context().SetTime(5.0);
  ticking.clock.now = 200.0;
  ticking.simulator.AdvanceTo(5.1);
  EXPECT_THAT(ticking.clock.slept_until.back(), DoubleNear(200.1, 1e-12));
  EXPECT_EQ(ticking.simulator.statistics().overruns, 0);
}

TEST(PacingTest, Line9TheMachinesClockIsWaitedFor) {
  WallClock& clock = WallClock::Steady();
  const double due = clock.Now() + 0.002;
  clock.SleepUntil(due);
  EXPECT_GE(clock.Now(), due);
}

TEST(PacingTest, RefusesFactorsThatAreNegativeOrNotFinite) {
  Ticking ticking;
  for (const double factor : {-1.0, -1e-300, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(ticking.simulator.SetRealtimeFactor(factor, ticking.clock), ConfigError);
  }
}

TEST(ProfileTest, CountsTheCallsOfEachSystemByItsPath) {
  DiagramBuilder inner;
  const auto& clock = inner.Add<blocks::Clock>("clock");
  const auto& delay = inner.Add<blocks::Delay>("delay", Every{Period(1, 10)});
  inner.Connect(clock.value, delay.in);
  DiagramBuilder builder;
  builder.AddSystem("part", inner.Build());
  builder.Add<blocks::Source>("idle", blocks::Vec({1.0}));
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  EXPECT_TRUE(simulator.profile().empty());
  simulator.AdvanceTo(0.5);
  simulator.EnableProfile();
  simulator.AdvanceTo(1.0);
  const auto profile = simulator.profile();
  ASSERT_EQ(profile.size(), 3u);
  EXPECT_EQ(profile[0].system, "part.clock");
  EXPECT_EQ(profile[0].calls, 5);
  EXPECT_GE(profile[0].seconds, 0.0);
  EXPECT_EQ(profile[1].system, "part.delay");
  EXPECT_EQ(profile[1].calls, 5);
  EXPECT_EQ(profile[2].system, "idle");
  EXPECT_EQ(profile[2].calls, 0);
}

TEST(ProfileTest, SortsCallsIntoClassesThatAreNarrowAndInOrder) {
  using Entry = Profile::Entry;
  std::size_t last = 0;
  for (std::uint64_t time = 0; time < 3'000'000'000; time += 1 + time / 40) {
    const std::size_t place = Entry::ClassOf(time);
    EXPECT_GE(place, last) << time;
    EXPECT_NEAR(1e9 * Entry::TimeOf(place), static_cast<double>(time),
                0.04 * static_cast<double>(time) + 1e-9)
        << time;
    last = place;
  }
  EXPECT_EQ(Entry::ClassOf(~std::uint64_t{0}), Entry::kClasses - 1);
  Entry entry;
  entry.Add(std::chrono::milliseconds(2));
  entry.Add(std::chrono::microseconds(1));
  EXPECT_EQ(entry.calls, 2);
  EXPECT_EQ(entry.slowest, std::chrono::milliseconds(2));
  EXPECT_EQ(entry.classes[Entry::ClassOf(2'000'000)], 1u);
}

TEST(ProfileTest, BelongsToItsSimulatorAndNotToCopiesOfItsContext) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Clock>());
  const auto value = diagram->GetOutput<Vector>("value");
  Simulator simulator(*diagram);
  simulator.EnableProfile();
  std::vector<Context> copies;
  simulator.AddMonitor([&](const Context& context) {
    copies.push_back(context);
    copies.back().SetTime(7.0);
    return true;
  });
  simulator.AdvanceTo(1.0);
  ASSERT_EQ(copies.size(), 1u);
  EXPECT_EQ(value.Eval(copies[0])[0], 7.0);
  EXPECT_EQ(value.Eval(simulator.context())[0], 1.0);
  EXPECT_EQ(simulator.profile()[0].calls, 0) << "evaluated outside AdvanceTo";
}

}  // namespace pacing_test
}  // namespace oca
