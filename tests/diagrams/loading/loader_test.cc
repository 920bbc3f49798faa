// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/loading/chain_file.h"

namespace oca::loading {
namespace loader_test {

using chain_file::Chain;
using testing::AllOf;
using testing::HasSubstr;

class LoaderTest : public chain_file::ChainFile {};

/// Chain() with its gain from part_low.yaml or part_high.yaml, which know `low`, and `high` and
/// `spare`.
std::string ChosenChain(const test::TemporaryFolder& folder, const std::string& parameters) {
  folder.Write("part_low.yaml", "parameters: {low: 3}\nsystems: {gain: {gain: \"${low}\"}}\n");
  folder.Write("part_high.yaml",
               "parameters: {high: 9, spare: 1}\nsystems: {gain: {gain: \"${high}\"}}\n");
  return "include: [\"part_${part}.yaml\"]\nparameters: {part: low, " + parameters + "}\n" +
         Chain(", gain: 3", "");
}

TEST_F(LoaderTest, AParameterOfAPartThatIsNotChosenIsNoMistakeButAMisspeltOneIs) {
  for (const char* known : {"low: 4", "high: 4", "spare: 4", "low: 4, high: 5"}) {
    EXPECT_THAT(Load(ChosenChain(folder, known)).warnings, testing::IsEmpty()) << known;
  }
  const auto warnings = Load(ChosenChain(folder, "hihg: 4")).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("d.yaml:2:25: warning: parameters.hihg: nothing uses it; did "
                                     "you mean 'high'?"));
}

TEST_F(LoaderTest, AnOverrideOfAParameterThatOnlyAnotherPartUsesIsToldToHaveNoEffect) {
  const std::string text = ChosenChain(folder, "high: 4");
  EXPECT_THAT(Load(text, {{"parameters.low", "5"}}).warnings, testing::IsEmpty());
  const auto warnings = Load(text, {{"parameters.high", "5"}}).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "-s parameters.high: warning: nothing uses it with the parts that are chosen");
}

TEST_F(LoaderTest, OneWrongParameterIsOneErrorHoweverManySystemsUseIt) {
  const std::string text =
      "parameters: {rate: 0}\n"
      "systems:\n"
      "  a: {type: ZeroOrderHold, period: \"${1 / rate}\"}\n"
      "  b: {type: ZeroOrderHold, period: \"${1 / rate}\"}\n"
      "  c: {type: ZeroOrderHold, period: 0}\n"
      "connections:\n"
      "  - a.out -> b.in\n";
  const std::string refusal = Refusal(text);
  EXPECT_THAT(refusal, HasSubstr("d.yaml:3:36: error: ${1 / rate}: the result is not finite; rate "
                                 "is 0 (d.yaml:1:20)"));
  EXPECT_THAT(refusal, HasSubstr("systems.c"));  // has an error of its own
  EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 1) << refusal;
  std::string word = text;
  word.replace(word.find("rate: 0"), 7, "rate: x");
  EXPECT_THAT(Refusal(word), HasSubstr("${1 / rate}: 'rate' is 'x'; expected a number\n"));
  EXPECT_EQ(Refusal(word).find("rate}"), Refusal(word).rfind("rate}"));
}

TEST_F(LoaderTest, LoadsWhatIsRight) {
  const LoadedDiagram loaded = Load(Chain());
  EXPECT_EQ(loaded.name, "chain");
  EXPECT_EQ(loaded.simulator.duration, 1.0);
  ASSERT_EQ(loaded.systems.size(), 3u);
  EXPECT_EQ(loaded.systems[1].name, "gain");
  EXPECT_EQ(loaded.systems[1].type, "Gain");
  EXPECT_EQ(loaded.diagram->connections().size(), 2u);
}

TEST_F(LoaderTest, TheNameIsThatOfTheFileIfNoneIsGiven) {
  EXPECT_EQ(Load(Chain("name: chain", "description: x")).name, "d");
}

TEST_F(LoaderTest, NamesAnUnknownTopLevelKeyAndTheNearest) {
  EXPECT_THAT(Refusal(Chain("simulator:", "simulater:")),
              HasSubstr("d.yaml:2:1: error: simulater: unknown key; did you mean 'simulator'?"));
}

TEST_F(LoaderTest, ReportsAllErrorsOfAFileAtOnce) {
  const std::string refusal = Refusal(
      "names: x\n"
      "simulator: {duration: -1, integrator: rk5}\n"
      "systems:\n"
      "  a: {type: Gian}\n"
      "  b: {type: Gain, gain: one}\n"
      "  c: {type: FirstOrderLag, time_constant: -0.1}\n"
      "  d: {type: Gain, gain: \"${unknown}\"}\n"
      "connections:\n"
      "  - x.y -> c.in\n"
      "  - nonsense\n");
  for (const char* part :
       {"d.yaml:1:1: error: names: unknown key; did you mean 'name'?",
        "d.yaml:2:23: error: simulator.duration: got -1 s; expected in [0, 10000000]",
        "d.yaml:2:39: error: simulator.integrator: got 'rk5'; expected one of erk_dp5",
        "d.yaml:4:13: error: systems.a.type: no system type 'Gian'; did you mean 'Gain'?",
        "d.yaml:5:25: error: systems.b.gain: got 'one'; expected a number",
        "d.yaml:6:43: error: systems.c.time_constant: got -0.1 s; expected > 0",
        "d.yaml:7:25: error: ${...}: unknown parameter 'unknown'",
        "d.yaml:9:5: error: connections: no system 'x'",
        "d.yaml:10:5: error: connections: got 'nonsense'; expected 'system.output -> "
        "system.input'"}) {
    EXPECT_THAT(refusal, HasSubstr(part));
  }
  EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 8) << refusal;
}

TEST_F(LoaderTest, ReportsWiringRecordAndExpectationsTogether) {
  const std::string refusal =
      Refusal(Chain("  - source.value -> gain.in\n", "") +
              "record: {signals: {lag.otu: 100}}\nexpect: {'lag.otu[0]': {equal: 1}}\n");
  EXPECT_THAT(refusal, HasSubstr("d.yaml:5:3: error: gain.in"));
  EXPECT_THAT(refusal, HasSubstr("no output matches 'lag.otu'; did you mean 'lag.out'?"));
  EXPECT_THAT(refusal,
              HasSubstr("expect.lag.otu[0]: no output 'lag.otu'; did you mean 'lag.out'?"));
}

TEST_F(LoaderTest, DurationsAndTolerancesOutOfBoundsAreRefused) {
  for (const char* simulator :
       {"{duration: -1}", "{duration: 1e8}", "{relative_tolerance: 0}", "{absolute_tolerance: -1}",
        "{fixed_step: 0}", "{max_steps: 0}", "{max_step: 0}", "{seed: -1}", "{seed: 1.5}",
        "{duration: long}", "{integrator: 3}", "3", "[1]"}) {
    EXPECT_THAT(Refusal(Chain("{duration: 1}", simulator)), HasSubstr("d.yaml:2:")) << simulator;
  }
  EXPECT_EQ(Load(Chain("{duration: 1}", "{duration: 0}")).simulator.duration, 0.0);
  EXPECT_EQ(Load(Chain("{duration: 1}", "{duration: 1e7}")).simulator.duration, 1e7);
}

TEST_F(LoaderTest, TolerancesOfUnknownSystemsAreRefused) {
  EXPECT_THAT(Refusal(Chain() + "simulator_tolerances: {lagg: {relative: 1e-3}}\n"),
              AllOf(HasSubstr("d.yaml:10:24: error: "), HasSubstr("did you mean 'lag'?")));
  EXPECT_EQ(Refusal(Chain() + "simulator_tolerances: {lag: {relative: 1e-3}}\n"), "");
  EXPECT_THAT(Refusal(Chain() + "simulator_tolerances: {lag: {relative: 0}}\n"),
              HasSubstr("simulator_tolerances.lag.relative"));
}

TEST_F(LoaderTest, AnExpressionThatLacksQuotesIsAnsweredWithAdvice) {
  EXPECT_THAT(Refusal(Chain("gain: 3", "gain: ${1 + 2}")),
              AllOf(HasSubstr("d.yaml:5:"), HasSubstr("an expression needs quotes")));
}

TEST_F(LoaderTest, TextAndListsInPlaceOfNamesAreRefused) {
  EXPECT_THAT(Refusal(Chain("name: chain", "name: 3")), HasSubstr("name: got 3; expected text"));
  EXPECT_THAT(Refusal("parameters: [1]\n" + Chain()),
              HasSubstr("parameters: got a list; expected a map"));
  EXPECT_THAT(Refusal("models: [1]\n" + Chain()), HasSubstr("models: got a list; expected a map"));
}

TEST_F(LoaderTest, RecordsOfUnknownSignalsAndRatesAreRefused) {
  const auto with = [&](const std::string& record) {
    return Refusal(Chain() + "record: " + record + "\n");
  };
  EXPECT_THAT(with("{signals: {lag.uot: 100}}"),
              HasSubstr("d.yaml:10:20: error: record.signals: no output matches 'lag.uot'; did you "
                        "mean 'lag.out'?"));
  EXPECT_THAT(with("{signals: {'*.none': 100}}"), HasSubstr("no output matches '*.none'"));
  for (const char* rate : {"0", "-1", "often", "[1]", "1.0e9"}) {
    EXPECT_THAT(with("{signals: {lag.out: " + std::string(rate) + "}}"),
                HasSubstr("expected a rate above 0, at most 1000000 Hz"))
        << rate;
  }
  EXPECT_THAT(with("{signal: {lag.out: 100}}"), HasSubstr("did you mean 'signals'?"));
  EXPECT_THAT(with("{signals: [lag.out]}"), HasSubstr("expected a map from names to rates"));
  EXPECT_THAT(with("{scene: 0}"), HasSubstr("record.scene: got 0"));
  EXPECT_EQ(with("{signals: {'*.out': 100, lag.out: 50}, scene: 60}"), "");
}

TEST_F(LoaderTest, ExpectationsThatNothingCanMeetAreRefused) {
  const auto with = [&](const std::string& expect) {
    return Refusal(Chain() + "expect: {" + expect + "}\n");
  };
  EXPECT_EQ(with("'lag.out[1]': {equal: 6, within: 1}"), "");
  EXPECT_THAT(with("'lag.out[2]': {equal: 6}"), HasSubstr("lag.out[i] with i from 0 to 1"));
  EXPECT_THAT(with("'lag.out[-1]': {equal: 6}"), HasSubstr("expected system.port[i]"));
  EXPECT_THAT(with("'lag.out[x]': {equal: 6}"), HasSubstr("expected system.port[i]"));
  EXPECT_THAT(with("'lag.out[0': {equal: 6}"), HasSubstr("expected system.port[i]"));
  EXPECT_THAT(with("lag.out: {equal: 6}"), HasSubstr("with i from 0 to 1"));
  EXPECT_THAT(with("lag.uot: {equal: 6}"), HasSubstr("did you mean 'lag.out'?"));
  EXPECT_THAT(with("lga.out: {equal: 6}"), HasSubstr("did you mean 'lag.out'?"));
  EXPECT_THAT(with("'lag.*': {equal: 6}"), HasSubstr("no output 'lag.*'"));
  EXPECT_THAT(with("min_distance: {at_least: 0}"), HasSubstr("needs a system that judges"));
  EXPECT_THAT(with("'lag.out[0]': {}"), HasSubstr("no bound; expected at_least"));
  EXPECT_THAT(with("'lag.out[0]': 3"), HasSubstr("expected a map"));
  EXPECT_THAT(with("'lag.out[0]': {at_lest: 3}"), HasSubstr("did you mean 'at_least'?"));
  EXPECT_THAT(with("'lag.out[0]': {at_least: 3, at: 2}"), HasSubstr("at most the duration 1 s"));
  EXPECT_THAT(with("'lag.out[0]': {at_least: 3, at: -1}"), HasSubstr("at: got -1 s"));
  EXPECT_EQ(with("'lag.out[0]': {at_least: 3, at: 1}"), "");
  EXPECT_THAT(with("'lag.out[0]': {at_least: 3, at_most: 2}"), HasSubstr("no value"));
}

TEST_F(LoaderTest, ExpectationsOnUnknownMetricsNameTheNearest) {
  const std::string text =
      Chain("connections:", "  metrics: {type: MotionMetrics, period: 0.01}\nconnections:") +
      "  - lag.out -> metrics.position\n  - source.value -> metrics.request\n";
  EXPECT_EQ(Refusal(text + "expect: {max_joint_speed: {at_most: 1}}\n"), "");
  EXPECT_THAT(Refusal(text + "expect: {max_joint_sped: {at_most: 1}}\n"),
              HasSubstr("did you mean 'max_joint_speed'?"));
}

TEST_F(LoaderTest, OverridesAreNamedInTheirErrors) {
  try {
    Load(Chain(), {{"systems.gain.gian", "3"}});
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("-s systems.gain.gian: error: systems.gain.gian: unknown key; did you mean "
                  "'gain'?"));
  }
  try {
    Load(Chain(), {{"systems.lag.time_constant", "-1"}});
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("-s systems.lag.time_constant"), HasSubstr("got -1 s")));
  }
}

}  // namespace loader_test
}  // namespace oca::loading
