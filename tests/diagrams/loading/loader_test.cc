// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>

#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "tests/temporary_folder.h"

namespace oca::loading {
namespace loader_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class LoaderTest : public testing::Test {
 protected:
  LoadedDiagram Load(const std::string& text, const std::vector<files::Override>& overrides = {}) {
    return LoadDiagram(folder.Write("d.yaml", text), overrides);
  }
  /// The error text, without the folder; empty if the text loads.
  std::string Refusal(const std::string& text) {
    try {
      Load(text);
      return "";
    } catch (const ConfigError& error) {
      std::string what = error.what();
      const std::string place = folder.path().string() + "/";
      for (auto at = what.find(place); at != std::string::npos; at = what.find(place)) {
        what.erase(at, place.size());
      }
      return what;
    }
  }
  test::TemporaryFolder folder;
};

/// A source, a gain and a lag in a row: line 2 is the simulator, 4 to 6 the systems, 8 and 9 the
/// connections. What a test replaces keeps these lines.
std::string Chain(const std::string& from = "", const std::string& to = "") {
  std::string text =
      "name: chain\n"
      "simulator: {duration: 1}\n"
      "systems:\n"
      "  source: {type: Constant, value: [1, 2], unit: rad}\n"
      "  gain: {type: Gain, gain: 3}\n"
      "  lag: {type: FirstOrderLag, time_constant: 0.1}\n"
      "connections:\n"
      "  - source.value -> gain.in\n"
      "  - gain.out -> lag.in\n";
  if (!from.empty()) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("nothing to replace: " + from);
    text.replace(at, from.size(), to);
  }
  return text;
}

const char* const kArm =
    "models: {arm: {urdf: package://lwr4/lwr4.urdf, srdf: package://lwr4/lwr4.srdf}}\n";

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

TEST_F(LoaderTest, NamesAnUnknownSystemTypeAndTheNearest) {
  EXPECT_THAT(
      Refusal(Chain("type: Gain", "type: Gian")),
      HasSubstr("d.yaml:5:16: error: systems.gain.type: no system type 'Gian'; did you mean "
                "'Gain'?"));
}

TEST_F(LoaderTest, NamesAnUnknownParameterAndTheNearest) {
  EXPECT_THAT(
      Refusal(Chain("gain: 3", "gian: 3")),
      HasSubstr("d.yaml:5:22: error: systems.gain.gian: unknown key; did you mean 'gain'?"));
}

TEST_F(LoaderTest, NamesUnknownPortsAndTheNearest) {
  EXPECT_THAT(Refusal(Chain("gain.out ->", "gain.oot ->")),
              AllOf(HasSubstr("d.yaml:9:5: error: connections: gain: "), HasSubstr("oot"),
                    HasSubstr("did you mean 'out'?")));
  EXPECT_THAT(Refusal(Chain("-> lag.in", "-> lag.input")),
              AllOf(HasSubstr("d.yaml:9:5: error: connections: lag: "), HasSubstr("input")));
}

TEST_F(LoaderTest, NamesUnknownSystemsInConnectionsAndTheNearest) {
  EXPECT_THAT(Refusal(Chain("gain.out ->", "gian.out ->")),
              HasSubstr("d.yaml:9:5: error: connections: no system 'gian'; did you mean 'gain'?"));
}

TEST_F(LoaderTest, ConnectionsThatAreNoneAreRefused) {
  for (const char* line : {"gain.out lag.in", "gain.out ->", "-> lag.in", "gain -> lag", "3",
                           "{gain.out: lag.in}", "gain.out -> lag.in -> lag.in", "[a]"}) {
    EXPECT_THAT(Refusal(Chain("gain.out -> lag.in", line)), HasSubstr("d.yaml:9:")) << line;
  }
  EXPECT_THAT(Refusal(Chain("connections:\n  - source.value -> gain.in\n  - gain.out -> lag.in\n",
                            "connections: {a: b}\n")),
              HasSubstr("connections: got a map; expected a list"));
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

TEST_F(LoaderTest, SizesThatDifferAreNamedWithBothSides) {
  EXPECT_THAT(Refusal(Chain("gain: 3", "gain: [1, 2, 3]")),
              AllOf(HasSubstr("d.yaml:8:5: error: "), HasSubstr("2"), HasSubstr("3"),
                    HasSubstr("gain.in"), HasSubstr("source.value")));
}

TEST_F(LoaderTest, UnitsThatDifferAreNamedWithBothSides) {
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: [0, 0, 0, 0, 0, 0, 0], unit: m}\n"
      "  kinematics: {type: RobotKinematics, model: arm}\n"
      "connections: [source.value -> kinematics.position]\n";
  EXPECT_THAT(Refusal(kArm + text), AllOf(HasSubstr("d.yaml:5:15: error: "), HasSubstr("unit"),
                                          HasSubstr("rad"), HasSubstr(" m")));
}

TEST_F(LoaderTest, SixJointsAgainstSevenAreRefused) {
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: [0, 0, 0, 0, 0, 0], unit: rad}\n"
      "  kinematics: {type: RobotKinematics, model: arm}\n"
      "connections: [source.value -> kinematics.position]\n";
  EXPECT_THAT(Refusal(kArm + text), AllOf(HasSubstr("size"), HasSubstr("6"), HasSubstr("7")));
}

TEST_F(LoaderTest, TypesThatDifferAreNamedWithBothSides) {
  const std::string text =
      "systems:\n"
      "  source: {type: ObstacleSource}\n"
      "  gain: {type: Gain, gain: 1}\n"
      "connections: [source.obstacles -> gain.in]\n";
  EXPECT_THAT(Refusal(text), AllOf(HasSubstr("d.yaml:4:15: error: "), HasSubstr("ObstacleSet"),
                                   HasSubstr("Vector")));
}

TEST_F(LoaderTest, TwoDriversOfOneInputAreRefused) {
  EXPECT_THAT(Refusal(Chain() + "  - source.value -> lag.in\n"),
              AllOf(HasSubstr("d.yaml:10:5: error: "), HasSubstr("lag.in")));
}

TEST_F(LoaderTest, AnUnconnectedInputIsNamed) {
  EXPECT_THAT(Refusal(Chain("  - source.value -> gain.in\n", "")),
              AllOf(HasSubstr("d.yaml:5:3: error: gain.in"), HasSubstr("not connected")));
}

TEST_F(LoaderTest, AnAlgebraicLoopIsShownAsAPath) {
  const std::string text =
      "systems:\n"
      "  a: {type: Gain, gain: 1}\n"
      "  b: {type: Gain, gain: 1}\n"
      "connections: [a.out -> b.in, b.out -> a.in]\n";
  EXPECT_THAT(Refusal(text),
              AllOf(HasSubstr("d.yaml:"), HasSubstr("algebraic loop"), HasSubstr("a.out"),
                    HasSubstr("b.in"), HasSubstr("b.out"), HasSubstr("a.in")));
}

TEST_F(LoaderTest, SystemsThatShareANameAreRefused) {
  EXPECT_THAT(Refusal(Chain("  gain:", "  source:")),
              HasSubstr("d.yaml:5:3: error: source: duplicate key; the first is at d.yaml:4:3"));
}

TEST_F(LoaderTest, NamesThatAreNoneAreRefused) {
  EXPECT_THAT(Refusal(Chain("  gain:", "  my gain:")),
              HasSubstr("d.yaml:5:3: error: systems.my gain"));
}

TEST_F(LoaderTest, ADiagramWithoutSystemsIsRefused) {
  EXPECT_THAT(Refusal("name: x\n"), HasSubstr("systems: missing; expected a map of named systems"));
  EXPECT_THAT(Refusal("systems: {}\n"), HasSubstr("systems: got none; expected at least one"));
  EXPECT_THAT(Refusal("systems: [1]\n"), HasSubstr("systems: got a list; expected a map"));
  EXPECT_THAT(Refusal("systems:\n"), HasSubstr("systems: no value"));
  EXPECT_THAT(Refusal("systems: {a: 3}\n"), HasSubstr("systems.a: got 3; expected a map"));
  EXPECT_THAT(Refusal("systems: {a: {gain: 3}}\n"), HasSubstr("systems.a.type: missing"));
  EXPECT_THAT(Refusal("systems: {a: {type: 3}}\n"), HasSubstr("systems.a.type: got 3"));
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

TEST_F(LoaderTest, APeriodOfZeroIsRefusedAndAFrequencyTaken) {
  const auto with = [&](const std::string& period) {
    return Chain("{type: Gain, gain: 3}", "{type: ZeroOrderHold, " + period + "}");
  };
  EXPECT_THAT(Refusal(with("period: 0")), HasSubstr("d.yaml:5:39: error: systems.gain.period"));
  EXPECT_THAT(Refusal(with("period: -0.01")), HasSubstr("systems.gain.period"));
  EXPECT_THAT(Refusal(with("frequency: 0")), HasSubstr("systems.gain.frequency: got 0 Hz"));
  EXPECT_THAT(Refusal(with("frequency: 100, period: 0.01")), HasSubstr("frequency"));
  EXPECT_EQ(Refusal(with("frequency: 60")), "");
  EXPECT_EQ(Refusal(with("period: \"${1 / 60}\"")), "");
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

TEST_F(LoaderTest, ModelsThatDoNotExistAreRefused) {
  const std::string kinematics = "systems: {k: {type: RobotKinematics, model: amr}}\n";
  EXPECT_THAT(Refusal(kArm + kinematics),
              AllOf(HasSubstr("d.yaml:2:"), HasSubstr("systems.k"), HasSubstr("amr"),
                    HasSubstr("did you mean 'arm'?")));
  EXPECT_THAT(Refusal("models: {arm: {urdf: missing.urdf}}\n" + kinematics),
              AllOf(HasSubstr("d.yaml:1:10: error: models.arm: "), HasSubstr("missing.urdf")));
  EXPECT_THAT(Refusal("models: {arm: {srdf: x}}\n" + kinematics),
              HasSubstr("models.arm: got neither urdf nor xacro; expected one of"));
  EXPECT_THAT(Refusal("models: {arm: {urdf: ''}}\n" + kinematics), HasSubstr("models.arm"));
  EXPECT_THAT(Refusal("models: {arm: {urdf: package://none/a.urdf}}\n" + kinematics),
              HasSubstr("no package 'none'; looked in packages"));
}

TEST_F(LoaderTest, AModelThatFailsIsReportedOnce) {
  const std::string refusal = Refusal(
      "models: {arm: {urdf: missing.urdf}}\n"
      "systems: {k: {type: RobotKinematics, model: arm}, s: {type: Constant, value: 1}}\n"
      "connections: [s.value -> k.position]\n");
  EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 0) << refusal;
}

TEST_F(LoaderTest, BasePosesThatAreNoneAreRefused) {
  const auto with = [&](const std::string& pose) {
    return Refusal("models: {arm: {urdf: package://planar2/planar2.urdf, base_pose: " + pose +
                   "}}\n" + Chain());
  };
  EXPECT_EQ(with("{xyz: [0, 0, 1], rpy: [0, 0, 0]}"), "");
  EXPECT_THAT(with("{xyz: [0, 0]}"), HasSubstr("models.arm.base_pose.xyz"));
  EXPECT_THAT(with("{xyz: [0, 0, a]}"), HasSubstr("models.arm.base_pose.xyz[2]"));
  EXPECT_THAT(with("{xyz: [0, 0, .nan]}"), HasSubstr("models.arm.base_pose.xyz[2]: got '.nan'"));
  EXPECT_THAT(with("{xyz: [0, -1000001, 0]}"), HasSubstr("models.arm.base_pose.xyz"));
  EXPECT_THAT(with("{xyz: [0, 0, 0], rpy: [1e300, 0, 0]}"), HasSubstr("models.arm.base_pose.rpy"));
  EXPECT_THAT(with("{quaternion: [0, 0, 0, 0]}"), HasSubstr("models.arm"));
  EXPECT_THAT(with("{zyx: [0, 0, 0]}"), HasSubstr("did you mean 'xyz'?"));
}

TEST_F(LoaderTest, AnInitialPositionOfTheWrongLengthIsRefused) {
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: [0, 0, 0], unit: rad/s}\n"
      "  plant: {type: IntegratorPlant, initial_position: [0, 0]}\n"
      "connections: [source.value -> plant.command]\n";
  EXPECT_THAT(Refusal(text), AllOf(HasSubstr("d.yaml:4:15: error: "), HasSubstr("size"),
                                   HasSubstr("2"), HasSubstr("3")));
}

TEST_F(LoaderTest, RecordsOfUnknownSignalsAndRatesAreRefused) {
  const auto with = [&](const std::string& record) {
    return Refusal(Chain() + "record: " + record + "\n");
  };
  EXPECT_THAT(with("{signals: {lag.uot: 100}}"),
              HasSubstr("d.yaml:10:20: error: record.signals: no output matches 'lag.uot'; did you "
                        "mean 'lag.out'?"));
  EXPECT_THAT(with("{signals: {'*.none': 100}}"), HasSubstr("no output matches '*.none'"));
  for (const char* rate : {"0", "-1", "often", "[1]"}) {
    EXPECT_THAT(with("{signals: {lag.out: " + std::string(rate) + "}}"),
                HasSubstr("expected a rate > 0 Hz"))
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

class PackageTest : public LoaderTest {
 protected:
  void SetUp() override {
    for (const char* place : {"own", "path/lwr4", "second/lwr4"}) {
      folder.Write(std::string(place) + "/lwr4.urdf",
                   "<robot name='" + std::string(place) + "'><link name='base'/></robot>");
    }
  }
  void TearDown() override { unsetenv("OCA_PACKAGE_PATH"); }
  std::string NameOfModel(const std::string& packages) {
    const LoadedDiagram loaded =
        Load(packages + "models: {arm: {urdf: package://lwr4/lwr4.urdf}}\n" + Chain());
    return loaded.models.Get("arm")->name().text();
  }
};

TEST_F(PackageTest, TheFileThenTheEnvironmentThenTheModelsOfOca) {
  EXPECT_EQ(NameOfModel(""), "lwr4");
  const std::string path = (folder.path() / "none").string() + ":" +
                           (folder.path() / "path").string() + ":" +
                           (folder.path() / "second").string();
  setenv("OCA_PACKAGE_PATH", path.c_str(), 1);
  EXPECT_EQ(NameOfModel(""), "path/lwr4");
  EXPECT_EQ(NameOfModel("packages: {lwr4: own}\n"), "own");
  EXPECT_EQ(NameOfModel("packages: {other: own}\n"), "path/lwr4");
}

TEST_F(PackageTest, FoldersThatAreNoTextAreRefused) {
  EXPECT_THAT(Refusal("packages: {lwr4: 3}\n" + Chain()),
              HasSubstr("packages.lwr4: got 3; expected a folder"));
}

TEST_F(LoaderTest, FilesAreFoundBesideTheFileThatNamesThem) {
  folder.Write("parts/box.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  folder.Write("parts/part.yaml",
               "systems:\n  obstacles:\n    type: ObstacleSource\n    obstacles: [{id: a, pose: "
               "{xyz: [0, 0, 0]}, shape: {type: "
               "mesh, file: box.obj}}]\n");
  EXPECT_EQ(Refusal("include: [parts/part.yaml]\n"), "");
  folder.Write("parts/part.yaml",
               "systems:\n  obstacles:\n    type: ObstacleSource\n    obstacles: [{id: a, pose: "
               "{xyz: [0, 0, 0]}, shape: {type: "
               "mesh, file: parts/box.obj}}]\n");
  EXPECT_THAT(Refusal("include: [parts/part.yaml]\n"), HasSubstr("parts/parts/box.obj"));
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

TEST_F(LoaderTest, AListWithAnItemThatDoesNotExistIsNotMistakenForZero) {
  EXPECT_THAT(Refusal(Chain("value: [1, 2]", "value: [1, two]")),
              HasSubstr("systems.source.value[1]: got 'two'"));
  EXPECT_THAT(Refusal(Chain("value: [1, 2]", "value: []")), HasSubstr("systems.source.value"));
  EXPECT_THAT(Refusal(Chain("value: [1, 2]", "value: [.nan, 2]")), HasSubstr("got '.nan'"));
}

TEST_F(LoaderTest, AnAttachedObjectBecomesALinkThatMovesWithItsCarrier) {
  const LoadedDiagram loaded = Load(
      "models:\n"
      "  arm:\n"
      "    urdf: package://planar2/planar2.urdf\n"
      "    attached:\n"
      "      - {id: cup, link: planar2_tip, shape: {type: sphere, radius: 0.05},\n"
      "         pose: {xyz: [0.1, 0, 0]}}\n" +
      Chain());
  const auto arm = loaded.models.Get("arm");
  EXPECT_EQ(arm->num_positions(), 2);
  const robot::Link& cup = arm->links()[arm->FindLink("cup")];
  EXPECT_EQ(cup.collisions.size(), 1u);
  const robot::Joint& joint = arm->joints()[cup.parent_joint];
  EXPECT_EQ(joint.parent_link, arm->FindLink("planar2_tip"));
  EXPECT_EQ(joint.X_PJ.translation(), Eigen::Vector3d(0.1, 0.0, 0.0));
}

TEST_F(LoaderTest, AttachedObjectsThatCannotBeAreRefused) {
  const auto with = [&](const std::string& object) {
    return Refusal("models: {arm: {urdf: package://planar2/planar2.urdf, attached: [" + object +
                   "]}}\n" + Chain());
  };
  const std::string ball = "shape: {type: sphere, radius: 0.05}";
  EXPECT_EQ(with("{id: cup, link: planar2_tip, " + ball + "}"), "");
  EXPECT_THAT(with("{id: cup, link: planar2_tpi, " + ball + "}"),
              AllOf(HasSubstr("models.arm"), HasSubstr("nearest is 'planar2_tip'")));
  EXPECT_THAT(with("{id: planar2_tip, link: planar2_tip, " + ball + "}"), HasSubstr("taken"));
  EXPECT_THAT(with("{id: cup, " + ball + "}"), HasSubstr("models.arm.attached[0].link"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, shape: {type: sphere, radius: 0}}"),
              HasSubstr("models.arm.attached[0].shape.radius"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, shape: {type: box}}"),
              HasSubstr("models.arm.attached[0].shape.size"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, shape: {type: half_space}}"),
              HasSubstr("models.arm.attached[0].shape.type: got a half_space"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, touchs: [], " + ball + "}"),
              HasSubstr("did you mean 'touches'?"));
}

}  // namespace loader_test
}  // namespace oca::loading
