// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, line 5: which zeros of a witness function are crossings.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"
#include "tests/framework/simulation/witness_blocks.h"

namespace oca {
namespace witness_guard_test {

using blocks::Vec;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using witness_test::Alarm;
using witness_test::Watched;

class WitnessGuardTest : public testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, WitnessGuardTest, testing::ValuesIn(kAllIntegrators),
                         NameOfKind);

TEST_P(WitnessGuardTest, Line5DirectionsChooseAmongCrossings) {
  const auto wave = [](double, double x) { return std::cos(std::numbers::pi * x); };
  const auto times = [&](Direction direction) {
    const Watched watched(wave, direction);
    Simulator simulator(*watched.diagram, {.integrator = GetParam()});
    simulator.AdvanceTo(4.0);
    return watched.alarm->times;
  };
  const auto near = [](double t) { return DoubleNear(t, 1e-10); };
  EXPECT_THAT(times(Direction::kBoth), ElementsAre(near(0.5), near(1.5), near(2.5), near(3.5)));
  EXPECT_THAT(times(Direction::kFalling), ElementsAre(near(0.5), near(2.5)));
  EXPECT_THAT(times(Direction::kRising), ElementsAre(near(1.5), near(3.5)));
}

TEST_P(WitnessGuardTest, Line5AGuardThatOnlyLeavesZeroDoesNotFire) {
  const Watched leaves([](double, double x) { return std::max(0.0, x - 0.5); });
  Simulator simulator(*leaves.diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(leaves.alarm->times, IsEmpty());
}

TEST_P(WitnessGuardTest, Line5AGuardThatReachesZeroAndStaysFiresOnce) {
  const Watched reaches([](double, double x) { return std::max(0.0, 0.5 - x); });
  Simulator simulator(*reaches.diagram, {.integrator = GetParam()});
  for (int i = 1; i <= 10; ++i) simulator.AdvanceTo(i / 10.0);
  EXPECT_THAT(reaches.alarm->times, ElementsAre(DoubleNear(0.5, 1e-10)));
}

TEST_P(WitnessGuardTest, Line5AGuardAtRestIsNotLostOverManyRestarts) {
  const auto rests = [](double, double x) { return x < 0.45 ? 0.0 : (x - 0.45) * (0.75 - x); };
  const Watched watched(rests, Direction::kFalling);
  Simulator simulator(*watched.diagram, {.integrator = GetParam()});
  for (int i = 1; i <= 10; ++i) simulator.AdvanceTo(i / 10.0);
  EXPECT_THAT(watched.alarm->times, ElementsAre(DoubleNear(0.75, 1e-10)));
}

TEST_P(WitnessGuardTest, Line5AGuardThatJumpsIsFoundEachTime) {
  const auto square = [](double, double x) { return std::fmod(x, 0.2) < 0.1 ? 1.0 : -1.0; };
  const Watched watched(square);
  Simulator simulator(*watched.diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(0.55);
  const auto near = [](double t) { return DoubleNear(t, 1e-10); };
  EXPECT_THAT(watched.alarm->times,
              ElementsAre(near(0.1), near(0.2), near(0.3), near(0.4), near(0.5)));
}

TEST_P(WitnessGuardTest, Line5TwoCrossingsOfOneGuardInOneStepAreSeen) {
  const Watched grazing([](double, double x) { return (x - 0.5) * (x - 0.5) - 1e-10; });
  Simulator simulator(*grazing.diagram, {.integrator = GetParam(), .fixed_step = 0.2});
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(grazing.alarm->times,
              ElementsAre(DoubleNear(0.49999, 1e-10), DoubleNear(0.50001, 1e-10)));
}

TEST_P(WitnessGuardTest, Line5AGuardThatStaysJustAboveZeroIsLeftAlone) {
  const Watched grazing([](double, double x) { return (x - 0.5) * (x - 0.5) + 1e-10; });
  Simulator simulator(*grazing.diagram, {.integrator = GetParam(), .fixed_step = 0.2});
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(grazing.alarm->times, IsEmpty());
}

TEST_P(WitnessGuardTest, Line5AJumpAcrossZeroByAnUpdateIsNoCrossing) {
  DiagramBuilder builder;
  const auto& counter = builder.Add<blocks::Counter>("counter", Every{Period(1, 10)});
  const auto& alarm =
      builder.Add<Alarm>("alarm", [](double t, double count) { return count - 4.5 + 0.0 * t; });
  builder.Connect(counter.value, alarm.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(alarm.times, IsEmpty());
}

TEST_P(WitnessGuardTest, Line5GuardsOfTimeAloneAreFoundWhereNothingElseMoves) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({50.0}));
  const auto& alarm =
      builder.Add<Alarm>("alarm", [](double t, double omega) { return std::cos(omega * t); });
  builder.Connect(source.value, alarm.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = GetParam()});
  simulator.AdvanceTo(10.0);
  ASSERT_THAT(alarm.times, SizeIs(159));
  for (std::size_t i = 0; i < alarm.times.size(); ++i) {
    EXPECT_NEAR(alarm.times[i], (static_cast<double>(i) + 0.5) * std::numbers::pi / 50.0, 1e-11);
  }
}

}  // namespace witness_guard_test
}  // namespace oca
