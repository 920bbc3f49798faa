// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/delay.h"

#include <gmock/gmock.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/ramp_source.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace delay_test {

using ::testing::HasSubstr;

std::string RefusalOf(const Delay::Params& params) {
  try {
    Delay delay(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

/// The ramp value = t behind a delay, looked at when time is `time`.
double DelayedRampAt(double time, const Delay::Params& params) {
  DiagramBuilder builder;
  const auto& ramp = builder.Add<RampSource>("ramp", RampSource::Params{});
  const auto& delay = builder.Add<Delay>("delay", params);
  builder.Connect(ramp.value, delay.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(time);
  return delay.out.Eval(simulator.context())[0];
}

TEST(DelayTest, ShowsAtEachTickTheInputOfTheDelayEarlier) {
  const Delay::Params params{.period = Period(1, 10), .delay = Period(3, 10), .initial = -1.0};
  EXPECT_NEAR(DelayedRampAt(1.0, params), 0.7, 1e-15);
  EXPECT_NEAR(DelayedRampAt(1.1, params), 0.8, 1e-15);
}

TEST(DelayTest, HoldsBetweenTicksWhatItShowsAtTheNext) {
  const Delay::Params params{.period = Period(1, 10), .delay = Period(3, 10)};
  EXPECT_NEAR(DelayedRampAt(1.01, params), 0.8, 1e-15);
  EXPECT_NEAR(DelayedRampAt(1.09, params), 0.8, 1e-15);
}

TEST(DelayTest, ShowsInitialUntilTheFirstSampleArrives) {
  const Delay::Params params{.period = Period(1, 10), .delay = Period(3, 10), .initial = -1.0};
  EXPECT_EQ(DelayedRampAt(0.0, params), -1.0);
  EXPECT_EQ(DelayedRampAt(0.2, params), -1.0);
  EXPECT_EQ(DelayedRampAt(0.21, params), 0.0);
}

TEST(DelayTest, StepsCountPeriods) {
  EXPECT_NEAR(DelayedRampAt(1.0, {.period = Period(1, 10), .steps = 3}), 0.7, 1e-15);
  EXPECT_NEAR(DelayedRampAt(1.0, {.period = Period(1, 10), .steps = 1}), 0.9, 1e-15);
}

TEST(DelayTest, DelaysEveryComponent) {
  SystemBench<Delay> bench(Delay::Params{
      .period = Period(1, 10), .steps = 2, .initial = Eigen::VectorXd(Eigen::Vector2d(5.0, 6.0))});
  bench->in.Fix(bench.context(), Eigen::Vector2d(1.0, 2.0));
  bench.AdvanceTo(0.1);
  EXPECT_EQ(Eigen::Vector2d(bench->out.Eval(bench.context())), Eigen::Vector2d(5.0, 6.0));
  bench.AdvanceTo(0.2);
  EXPECT_EQ(Eigen::Vector2d(bench->out.Eval(bench.context())), Eigen::Vector2d(1.0, 2.0));
}

TEST(DelayTest, ASavedContextContinuesTheSame) {
  SystemBench<Delay> bench(Delay::Params{.period = Period(1, 10), .steps = 2});
  bench->in.Fix(bench.context(), Eigen::VectorXd::Constant(1, 4.0));
  bench.AdvanceTo(0.1);
  const Context saved = bench.context();
  bench->in.Fix(bench.context(), Eigen::VectorXd::Constant(1, 9.0));
  bench.AdvanceTo(0.5);
  EXPECT_EQ(bench->out.Eval(bench.context())[0], 9.0);
  bench.context() = saved;
  bench.AdvanceTo(0.2);
  EXPECT_EQ(bench->out.Eval(bench.context())[0], 4.0);
}

TEST(DelayTest, RefusesADelayThatIsNoWholeNumberOfPeriods) {
  EXPECT_EQ(RefusalOf({.period = Period(1, 10), .delay = Period(1, 4)}),
            "delay: no whole number of periods; got 0.25 s; expected a multiple of 0.1 s");
  EXPECT_EQ(RefusalOf({.period = Period(1, 60), .delay = Period(1, 20)}), "accepted");
  EXPECT_THAT(RefusalOf({.period = Period(1, 10), .delay = Period(1, 100)}), HasSubstr("got 0"));
}

TEST(DelayTest, RefusesNoDelayTwoDelaysAndEndlessOnes) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 10)}), HasSubstr("steps: number of periods; got 0"));
  EXPECT_THAT(RefusalOf({.period = Period(1, 10), .delay = Period(1, 10), .steps = 1}),
              HasSubstr("twice"));
  EXPECT_THAT(RefusalOf({.period = Period(1, 1000), .delay = Period(11, 1)}),
              HasSubstr("expected 1 to 10000"));
  EXPECT_THAT(RefusalOf({.period = Period(), .steps = 1}), HasSubstr("period"));
}

}  // namespace delay_test
}  // namespace oca::systems
