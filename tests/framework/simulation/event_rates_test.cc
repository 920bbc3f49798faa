// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, line 4: several rates meet exactly, for ever.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace event_rates_test {

using testing::ElementsAre;
using testing::HasSubstr;

/// A diagram with one counter a period; `steps` are the simulator's after AdvanceTo(end).
struct Rates {
  explicit Rates(const std::vector<Every>& everies, bool remember = true) {
    DiagramBuilder builder;
    for (std::size_t i = 0; i < everies.size(); ++i) {
      auto counter = std::make_unique<blocks::Counter>(everies[i]);
      counter->remember = remember;
      counters.push_back(counter.get());
      builder.AddSystem("counter" + std::to_string(i), std::move(counter));
    }
    diagram = builder.Build();
    simulator = std::make_unique<Simulator>(*diagram);
  }
  double CountOf(int i) const { return counters[i]->value.Eval(simulator->context())[0]; }
  std::vector<const blocks::Counter*> counters;
  std::unique_ptr<Diagram> diagram;
  std::unique_ptr<Simulator> simulator;
};

TEST(SimulatorContractTest, Line4TenthsMeetThreeTenthsForADay) {
  Rates rates({{Period::FromSeconds(0.1)}, {Period::FromSeconds(0.3)}}, false);
  constexpr double kDay = 86400.0;
  rates.simulator->AdvanceTo(kDay);
  EXPECT_EQ(rates.CountOf(0), 864000.0);
  EXPECT_EQ(rates.CountOf(1), 288000.0);
  // Every third instant is shared: no step of its own for the slower one.
  EXPECT_EQ(rates.simulator->statistics().steps, 864000);
}

TEST(SimulatorContractTest, Line4FiveMillisecondsMeetASixtiethOfASecond) {
  Rates rates({{Period::FromSeconds(0.005)}, {Period::FromSeconds(1.0 / 60.0)}});
  rates.simulator->AdvanceTo(60.0);
  EXPECT_EQ(rates.CountOf(0), 12000.0);
  EXPECT_EQ(rates.CountOf(1), 3600.0);
  // 1/60 s = 10/600 s and 5 ms = 3/600 s meet every 30/600 s = 0.05 s.
  EXPECT_EQ(rates.simulator->statistics().steps, 12000 + 3600 - 1200);
}

TEST(SimulatorContractTest, Line4AMillisecondMeetsThreeFourAndTen) {
  Rates rates({{Period(1, 1000)}, {Period(3, 1000)}, {Period(4, 1000)}, {Period(10, 1000)}});
  rates.simulator->AdvanceTo(12.0);
  EXPECT_EQ(rates.CountOf(0), 12000.0);
  EXPECT_EQ(rates.CountOf(1), 4000.0);
  EXPECT_EQ(rates.CountOf(2), 3000.0);
  EXPECT_EQ(rates.CountOf(3), 1200.0);
  EXPECT_EQ(rates.simulator->statistics().steps, 12000);
  for (const double t : rates.counters[3]->times) {
    EXPECT_TRUE(
        std::binary_search(rates.counters[0]->times.begin(), rates.counters[0]->times.end(), t));
  }
}

TEST(SimulatorContractTest, Line4FiveMillisecondsMeetASixtiethOfASecondForADay) {
  Rates rates({{Period(5, 1000)}, {Period(1, 60)}}, false);
  rates.simulator->AdvanceTo(86400.0);
  EXPECT_EQ(rates.CountOf(0), 17280000.0);
  EXPECT_EQ(rates.CountOf(1), 5184000.0);
  EXPECT_EQ(rates.simulator->statistics().steps, 86400 * (200 + 60 - 20));
}

TEST(SimulatorContractTest, Line4AMillisecondMeetsThreeFourAndTenAtTheEndOfADayAsAtItsStart) {
  Rates rates({{Period(1, 1000)}, {Period(3, 1000)}, {Period(4, 1000)}, {Period(10, 1000)}});
  rates.simulator->context().SetTime(86388.0);
  rates.simulator->AdvanceTo(86400.0);
  EXPECT_EQ(rates.CountOf(0), 12000.0);
  EXPECT_EQ(rates.CountOf(1), 4000.0);
  EXPECT_EQ(rates.CountOf(2), 3000.0);
  EXPECT_EQ(rates.CountOf(3), 1200.0);
  EXPECT_EQ(rates.simulator->statistics().steps, 12000);
  for (int i = 0; i < 12000; ++i) EXPECT_EQ(rates.counters[0]->times[i], (86388000 + i) / 1000.0);
}

TEST(SimulatorContractTest, Line4TimesAreTheNearestDoublesOfTheExactOnes) {
  Rates rates({{Period(1, 10)}, {Period(1, 60)}});
  rates.simulator->AdvanceTo(100.0);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(rates.counters[0]->times[i], i / 10.0);
  for (int i = 0; i < 6000; ++i) EXPECT_EQ(rates.counters[1]->times[i], i / 60.0);
}

TEST(SimulatorContractTest, Line4OffsetsShiftEveryInstant) {
  Rates rates({{Period(1, 10), Period(1, 20)}, {Period(1, 10), Period(1, 4)}});
  rates.simulator->AdvanceTo(0.36);
  EXPECT_THAT(rates.counters[0]->times, ElementsAre(0.05, 0.15, 0.25, 0.35));
  EXPECT_THAT(rates.counters[1]->times, ElementsAre(0.25, 0.35));
  // Instants 0.05, 0.15, 0.25, 0.35 and the end: a step leads to each.
  EXPECT_EQ(rates.simulator->statistics().steps, 5);
}

TEST(SimulatorContractTest, Line4TheUpdateAtTheEndIsPendingAndTheOneJustBeforeIsNot) {
  for (const double end : {0.3, std::nextafter(0.3, 1.0)}) {
    Rates rates({{Period(1, 10)}});
    rates.simulator->AdvanceTo(end);
    EXPECT_EQ(rates.CountOf(0), end == 0.3 ? 3.0 : 4.0) << end;
  }
}

TEST(SimulatorContractTest, Line4StopsBetweenTicksLoseNoneAndRepeatNone) {
  Rates straight({{Period(1, 100)}, {Period(3, 1000)}});
  Rates stopped({{Period(1, 100)}, {Period(3, 1000)}});
  straight.simulator->AdvanceTo(2.0);
  for (double t = 0.0; t < 2.0; t += 0.0017) stopped.simulator->AdvanceTo(t);
  stopped.simulator->AdvanceTo(2.0);
  EXPECT_EQ(straight.counters[0]->times, stopped.counters[0]->times);
  EXPECT_EQ(straight.counters[1]->times, stopped.counters[1]->times);
}

TEST(SimulatorContractTest, Line4ARunThatStartsLaterKeepsTheGridOfZero) {
  Rates rates({{Period(1, 10)}});
  rates.simulator->context().SetTime(0.25);
  rates.simulator->AdvanceTo(0.5);
  EXPECT_THAT(rates.counters[0]->times, ElementsAre(0.3, 0.4));
  Rates on_the_grid({{Period(1, 10)}});
  on_the_grid.simulator->context().SetTime(0.3);
  on_the_grid.simulator->AdvanceTo(0.5);
  EXPECT_THAT(on_the_grid.counters[0]->times, ElementsAre(0.3, 0.4));
}

TEST(SimulatorContractTest, Line4PeriodsWithoutACommonClockAreRefusedClearly) {
  const auto text_of = [](const std::vector<Every>& everies) -> std::string {
    try {
      Rates rates(everies);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(text_of({{Period(1, 999983)}, {Period(1, 1000)}}), "");
  EXPECT_THAT(text_of({{Period(1, 999983)}, {Period(1, 999979)}}),
              HasSubstr("got 1/999979 s, which shares no clock with the others"));
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(text_of({{Period(1, kLargest)}}), HasSubstr("shares no clock"));
  EXPECT_THAT(text_of({{Period(kLargest, 2)}}), HasSubstr("expected at most"));
  EXPECT_THAT(text_of({{Period(1000000000, 1)}, {Period(1, 1000000000)}}),
              HasSubstr("expected at most"));
}

TEST(SimulatorContractTest, Line4AStartTooLateToCountTicksIsRefused) {
  Rates rates({{Period(1, 1000)}});
  rates.simulator->context().SetTime(1e300);
  EXPECT_THROW(rates.simulator->Initialize(), ConfigError);
}

}  // namespace event_rates_test
}  // namespace oca
