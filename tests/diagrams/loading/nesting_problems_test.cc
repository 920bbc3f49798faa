// SPDX-License-Identifier: BSD-3-Clause
// What is said of files that are used wrongly, or are wrong themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "oca/diagrams/files/catalogue.h"
#include "oca/systems/signals/roles.h"
#include "tests/diagrams/loading/nested_files.h"

namespace oca::loading {
namespace nesting_problems_test {

using nested_files::kStage;
using nested_files::TwoStages;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class NestingProblemsTest : public nested_files::NestedFiles {};

int Count(const std::string& text, const std::string& what) {
  int count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST_F(NestingProblemsTest, RefusesParametersThatTheFileDoesNotHave) {
  const std::string refusal = Refusal(TwoStages(", parameters: {fctor: 5}"));
  EXPECT_EQ(refusal,
            "d.yaml:5:57: error: systems.first.parameters.fctor: stage.yaml has no such parameter; "
            "did you mean 'factor'?");
}

TEST_F(NestingProblemsTest, RefusesKeysThatAUseDoesNotHave) {
  EXPECT_THAT(Refusal(TwoStages(", parameter: {factor: 5}")),
              AllOf(HasSubstr("d.yaml:5:44: error: systems.first.parameter: unknown key"),
                    HasSubstr("did you mean 'parameters'?")));
  EXPECT_THAT(Refusal("systems:\n  a: {type: Diagram}\n"),
              HasSubstr("d.yaml:2:3: error: systems.a.file: missing; expected a diagram file"));
  EXPECT_THAT(Refusal("systems:\n  a: {type: Diagram, file: none.yaml}\n"),
              AllOf(HasSubstr("d.yaml:2:28: error: systems.a.file: "), HasSubstr("none.yaml")));
  EXPECT_THAT(Refusal("systems:\n  a: {type: Diagram, file: stage.yaml, parameters: 3}\n"),
              HasSubstr("parameters: got 3; expected a map, or a list of maps"));
}

TEST_F(NestingProblemsTest, TellsAProblemOfTheFileOnceWithAllItsUses) {
  folder.Write("stage.yaml",
               std::string(kStage).replace(std::string(kStage).find("Gain"), 4, "Gian"));
  const std::string refusal = Refusal(TwoStages());
  EXPECT_THAT(refusal,
              HasSubstr("stage.yaml:4:16: error: in first and second: systems.gain.type: no "
                        "system type 'Gian'; did you mean 'Gain'?"));
  EXPECT_EQ(Count(refusal, "Gian"), 1);
}

TEST_F(NestingProblemsTest, CollectsProblemsOfAllFilesAtOnce) {
  const std::string refusal =
      Refusal(TwoStages(", parameters: {constant: -1}", "", "  - source.valeu -> second.out\n"));
  EXPECT_THAT(refusal, HasSubstr("stage.yaml:5:"));
  EXPECT_THAT(refusal, HasSubstr("error: in first: systems.lag.time_constant: got -1"));
  EXPECT_THAT(refusal,
              HasSubstr("d.yaml:10:5: error: connections: source: no output port 'valeu'"));
}

TEST_F(NestingProblemsTest, TellsWiringProblemsInTheFileAsItNamesPorts) {
  folder.Write("stage.yaml", std::string(kStage) + "  - lag.out -> gain.in\n");
  EXPECT_EQ(Refusal(TwoStages()),
            "stage.yaml:10:5: error: in first and second: gain.in: two drivers; got this and "
            "inputs.in; expected one");
  folder.Write("stage.yaml", std::string(kStage) + "  - gain.out -> outputs.slow\n");
  EXPECT_EQ(Refusal(TwoStages()),
            "stage.yaml:10:5: error: in first and second: connections: outputs.slow: two drivers; "
            "got lag.out and gain.out; expected one");
  std::string stage = std::string(kStage) + "  - gain.out -> sum.in0\n";
  stage.insert(stage.find("connections:"), "  sum: {type: Sum, signs: [1, 1]}\n");
  folder.Write("stage.yaml", stage);
  EXPECT_THAT(
      Refusal(TwoStages()),
      HasSubstr("stage.yaml:6:3: error: in first and second: sum.in1: input not connected"));
}

TEST_F(NestingProblemsTest, TellsOfAnInputThatTheOtherFileLeavesOpenWhereTheUseStands) {
  std::string text = TwoStages();
  text.erase(text.find("  - first.slow"));
  EXPECT_THAT(Refusal(text),
              AllOf(HasSubstr("d.yaml:6:3: error: second.in: second.gain.in: input not connected"),
                    Not(HasSubstr("first"))));
}

TEST_F(NestingProblemsTest, RefusesAFileThatUsesItselfAndNamesTheChain) {
  folder.Write("a.yaml", "systems: {b: {type: Diagram, file: b.yaml}}\n");
  folder.Write("b.yaml", "systems: {a: {type: Diagram, file: a.yaml}}\n");
  EXPECT_THAT(Refusal("systems: {a: {type: Diagram, file: a.yaml}}\n"),
              AllOf(HasSubstr("b.yaml:1:36: error: in a.b: systems.a.file: "),
                    HasSubstr("uses itself: a.yaml -> b.yaml -> a.yaml")));
}

TEST_F(NestingProblemsTest, NamesAnOverrideThatLeadsNowhereAsItWasGiven) {
  EXPECT_THAT(Refusal(TwoStages(), {{"first.parameters.fctor", "4"}}),
              AllOf(HasSubstr("-s first.parameters.fctor: error: in first: no 'fctor' there"),
                    HasSubstr("did you mean 'factor'?")));
  EXPECT_THAT(Refusal(TwoStages(), {{"frist.parameters.factor", "4"}}),
              HasSubstr("no 'frist' there; did you mean 'first'?"));
  EXPECT_THAT(Refusal(TwoStages(), {{"*.systems.lag.time_constant", "-1"}}),
              HasSubstr("-s *.systems.lag.time_constant:1:1: error: in first and second: "
                        "systems.lag.time_constant: got -1"));
}

TEST_F(NestingProblemsTest, NamesTheMetricOfAUsedFileThatAnExpectationMayMean) {
  const auto refusal = [&](const std::string& key) {
    return Refusal("include: [" OCA_SOURCE_DIR "/diagrams/dual_arm.yaml]\nexpect: {'" + key +
                   "': {at_least: 0}}\n");
  };
  EXPECT_THAT(refusal("lft.min_distance"),
              HasSubstr("expect.lft.min_distance: no output 'lft.min_distance'; did you mean "
                        "'left.min_distance'?"));
  EXPECT_THAT(refusal("lft.plant.position[0]"), HasSubstr("did you mean 'left.plant.position'?"));
}

TEST_F(NestingProblemsTest, RefusesPortsThatTheFileDoesNotName) {
  EXPECT_THAT(Refusal(TwoStages("", "", "  - source.value -> first.gain\n")),
              AllOf(HasSubstr("d.yaml:10:5: error: connections: first: no input 'gain' of "),
                    HasSubstr("its inputs are: in")));
  EXPECT_THAT(Refusal(TwoStages("", "", "  - first.slwo -> gain.in\n")),
              HasSubstr("did you mean 'slow'?"));
  EXPECT_THAT(Refusal("systems: {inputs: {type: Gain}}\n"),
              HasSubstr("systems.inputs: stands for the ports of the file"));
}

TEST_F(NestingProblemsTest, RefusesAFileThatDrawsScenarios) {
  folder.Write("stage.yaml",
               std::string(kStage) + "sampling: {draw: {factor: {uniform: [1, 2]}}}\n");
  EXPECT_THAT(Refusal(TwoStages()),
              HasSubstr("in first and second: sampling: got a file that draws scenarios"));
}

TEST_F(NestingProblemsTest, RefusesAPortThatCannotBeNamedSoAndConnectsNothingToTheFile) {
  std::string stage = kStage;
  stage.replace(stage.find("outputs.slow"), 12, "outputs.my-y");
  folder.Write("stage.yaml", stage);
  EXPECT_THAT(Refusal("systems:\n"
                      "  s: {type: Constant, value: [1], unit: rad}\n"
                      "  f: {type: Diagram, file: stage.yaml}\n"
                      "  h: {type: Gain, gain: 2}\n"
                      "connections: [s.value -> f.in, f.gain.out -> h.in, <a>.out -> h.in]\n"),
              AllOf(HasSubstr("d.yaml:3:3: error: systems.f: "), HasSubstr("'my-y'")));
}

TEST_F(NestingProblemsTest, ConnectsNothingToASystemThatCannotBeNamedSo) {
  EXPECT_THAT(Refusal("systems:\n"
                      "  a-b: {type: Constant, value: [1], unit: rad}\n"
                      "  h: {type: Gain, gain: 2}\n"
                      "connections: [a-b.value -> h.in, h.out -> a-b.in, <x>.value -> h.in]\n"),
              HasSubstr("d.yaml:2:3: error: systems.a-b: "));
}

TEST_F(NestingProblemsTest, DoesNotAskAFileWithProblemsForItsPorts) {
  folder.Write("stage.yaml",
               std::string(kStage).replace(std::string(kStage).find("Gain"), 4, "Gian"));
  folder.Write("outer.yaml",
               "systems: {stage: {type: Diagram, file: stage.yaml}}\n"
               "connections: [inputs.in -> stage.in, stage.slow -> outputs.slow]\n");
  std::string text = TwoStages();
  text.replace(text.find("second: {type: Diagram, file: stage"), 35,
               "second: {type: Diagram, file: outer");
  const std::string refusal = Refusal(text);
  EXPECT_EQ(Count(refusal, "error:"), 1) << refusal;
  EXPECT_THAT(refusal, HasSubstr("stage.yaml:4:16: error: in first and second.stage: "));
}

TEST_F(NestingProblemsTest, RefusesAnOverrideOfWhatAFileAroundSays) {
  folder.Write("stage.yaml", std::string(kStage) +
                                 "simulator_tolerances: {lag: {relative: 1.0e-3}}\n"
                                 "record: {signals: {lag.out: 10}}\n"
                                 "expect: {\"lag.out[0]\": {at_most: 100}}\n");
  const std::string text = TwoStages("", "",
                                     "simulator_tolerances: {first.lag: {relative: 1.0e-4}}\n"
                                     "record: {signals: {\"first.*\": 20}}\n"
                                     "expect: {\"first.lag.out[0]\": {at_most: 50}}\n");
  for (const auto& [path, value] :
       {std::pair{"expect.lag.out[0].at_most", "1"}, std::pair{"record.signals.lag.out", "5"},
        std::pair{"simulator_tolerances.lag.relative", "1.0e-6"}}) {
    const std::string own = path;
    EXPECT_EQ(Refusal(text, {{"second." + own, value}}), "");
    EXPECT_THAT(Refusal(text, {{"first." + own, value}}),
                AllOf(HasSubstr("-s first." + own + ": error: in first: "),
                      HasSubstr("without effect; a file that uses this one says it of 'first'")));
  }
  EXPECT_EQ(
      Load(text, {{"second.expect.lag.out[0].at_most", "1"}}).expectations.at(1).bound.at_most, 1);
}

TEST_F(NestingProblemsTest, RefusesAnOverrideOfTheRunInAUsedFile) {
  for (const std::string path : {"simulator.duration", "name", "description", "record.scene"}) {
    EXPECT_THAT(Refusal(TwoStages(), {{"*." + path, "2"}}),
                AllOf(HasSubstr("-s *." + path + ": error: in first and second: "),
                      HasSubstr("is not looked at in a file that another one uses"),
                      HasSubstr("-s " + path)));
  }
}

TEST_F(NestingProblemsTest, WarnsOfAnExpectationAfterTheEndOfTheRun) {
  folder.Write("stage.yaml",
               std::string(kStage) + "expect: {\"lag.out[0]\": {at_most: 100, at: 5}}\n");
  const LoadedDiagram loaded = Load(TwoStages());
  EXPECT_TRUE(loaded.expectations.empty());
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_THAT(WithoutFolder(loaded.warnings.front()),
              AllOf(HasSubstr("stage.yaml:10:"),
                    HasSubstr("warning: in first and second: expect.lag.out[0].at: got 5 s, after "
                              "the run, which ends at 1 s: it is not checked")));
  EXPECT_TRUE(Load(TwoStages("", "",
                             "expect: {\"first.lag.out[0]\": {at_most: 9}, \"second.lag.out[0]\": "
                             "{at_most: 9}}\n"))
                  .warnings.empty());
}

TEST_F(NestingProblemsTest, TellsTheWholePathOfAnOverrideWithAWrongValue) {
  EXPECT_THAT(Refusal(TwoStages(), {{"first.systems.lag.time_constant", "-1"}}),
              HasSubstr("-s first.systems.lag.time_constant:1:1: error: in first: "));
}

TEST_F(NestingProblemsTest, RefusesAUsedFileWithTheNameOfASection) {
  EXPECT_THAT(Refusal("systems:\n"
                      "  record: {type: Diagram, file: stage.yaml}\n"
                      "  simulator: {type: Gain, gain: 2}\n"),
              AllOf(HasSubstr("d.yaml:2:3: error: systems.record: "),
                    HasSubstr("expected another name for a used file"),
                    Not(HasSubstr("systems.simulator"))));
}

TEST_F(NestingProblemsTest, ChecksWhatAUsedFileSaysOfARun) {
  folder.Write("stage.yaml", std::string(kStage) +
                                 "description: 3\n"
                                 "simulator: {duration: -1, intgrator: rk4}\n"
                                 "record: {scene: -5}\n");
  EXPECT_THAT(
      Refusal(TwoStages()),
      AllOf(HasSubstr("stage.yaml:10:14: error: in first and second: description: got 3"),
            HasSubstr("stage.yaml:11:23: error: in first and second: simulator.duration: got -1"),
            HasSubstr("simulator.intgrator: unknown key"),
            HasSubstr("record.scene: got -5; expected a rate above 0, at most 1000000 Hz")));
  folder.Write("stage.yaml", std::string(kStage) + "simulator: {duration: 99}\n");
  EXPECT_EQ(Load(TwoStages()).simulator.duration, 1.0);
}

TEST_F(NestingProblemsTest, WarnsOfAnInputOfTheFileThatLeadsToNoPort) {
  folder.Write("stage.yaml", std::string(kStage) +
                                 "  - inputs.in -> <any>.inn\n"
                                 "  - inputs.more_<x> -> gain.more_<x>\n");
  const auto warnings = Load(TwoStages()).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(WithoutFolder(warnings.front()),
            "stage.yaml:10:5: warning: in first and second: connections: inputs.in -> <any>.inn: "
            "no ports have such names");
}

TEST_F(NestingProblemsTest, TellsAnAlgebraicLoopOnceAtItsConnection) {
  folder.Write("loop.yaml",
               "systems: {g: {type: Gain, gain: 1}, h: {type: Gain, gain: 1}}\n"
               "connections:\n"
               "  - h.out -> g.in\n"
               "  - g.out -> h.in\n");
  const std::string refusal = Refusal(
      "systems: {a: {type: Diagram, file: loop.yaml}, b: {type: Diagram, file: loop.yaml}}\n");
  EXPECT_EQ(Count(refusal, "algebraic loop"), 1) << refusal;
  EXPECT_THAT(refusal,
              HasSubstr("loop.yaml:4:5: error: in a and b: algebraic loop: g.out -> h.in -> h.out "
                        "-> g.in -> g.out;"));
}

TEST_F(NestingProblemsTest, TellsAnAlgebraicLoopThroughUsedFilesWhereTheyAreConnected) {
  folder.Write("gain.yaml",
               "systems: {g: {type: Gain, gain: 1}, h: {type: Gain, gain: 1}}\n"
               "connections: [inputs.in -> g.in, g.out -> h.in, h.out -> outputs.out]\n");
  EXPECT_THAT(Refusal("systems:\n"
                      "  a: {type: Diagram, file: gain.yaml}\n"
                      "  b: {type: Diagram, file: gain.yaml}\n"
                      "connections:\n"
                      "  - a.out -> b.in\n"
                      "  - b.out -> a.in\n"),
              HasSubstr("d.yaml:5:5: error: algebraic loop: a.g.out -> a.h.in -> a.h.out -> "
                        "b.g.in -> b.g.out -> b.h.in -> b.h.out -> a.g.in -> a.g.out;"));
}

TEST_F(NestingProblemsTest, TellsAStateOfAUsedFileThatStartsWhereItCannotBe) {
  folder.Write(
      "stage.yaml",
      "models: {arm: {urdf: package://planar2/planar2.urdf}}\n"
      "systems:\n"
      "  rate: {type: Constant, value: [0, 0], unit: rad/s}\n"
      "  plant: {type: IntegratorPlant, initial_position: [0, 1.0e+7]}\n"
      "  kinematics: {type: RobotKinematics, model: arm}\n"
      "connections: [rate.value -> plant.command, plant.position -> kinematics.position]\n");
  EXPECT_THAT(Refusal("systems:\n"
                      "  a: {type: Diagram, file: stage.yaml}\n"),
              HasSubstr("stage.yaml:4:3: error: in a: plant.position at t = 0 s: "));
}

/// Judges with something that is no metrics.
class Guesser final : public System {
 public:
  Guesser() : guess(DeclareOutput<Vector, &Guesser::Calc>("guess", {1, Unit::Any()})) {
    DeclareRole(systems::Judges{.metrics = guess});
  }

 private:
  void Calc(MutableVectorView out) const { out[0] = 1.0; }

 public:
  const Output<Vector> guess;
};

TEST_F(NestingProblemsTest, TellsOfAJudgeOfAUsedFileThatHasNoMetrics) {
  auto catalogue = files::Catalogue::Standard();
  catalogue.Add("Guesser", {"guesses", "", ""}, [] { return std::make_unique<Guesser>(); });
  folder.Write("stage.yaml", "systems:\n  judge: {type: Guesser}\n");
  const auto load = [&] {
    LoadDiagram(folder.Write("d.yaml",
                             "systems:\n"
                             "  a: {type: Diagram, file: stage.yaml}\n"
                             "  b: {type: Diagram, file: stage.yaml}\n"),
                {}, catalogue);
  };
  EXPECT_THAT(load, testing::ThrowsMessage<ConfigError>(
                        HasSubstr("stage.yaml:2:3: error: in a and b: systems.judge: judge: ")));
}

TEST_F(NestingProblemsTest, RefusesPlacesForNamesThatNothingSeparates) {
  for (const std::string pattern : {"<a><b>.out", "<a>_<b>.out", "x.<a>y<b>"}) {
    EXPECT_THAT(Refusal(TwoStages("", "", "  - " + pattern + " -> <a>.in\n")),
                HasSubstr("d.yaml:10:5: error: connections: got '" + pattern +
                          "'; expected a dot between two places for names"));
  }
  EXPECT_EQ(Refusal(TwoStages("", "", "  - <a>.<b> -> <b>.links_<a>\n")), "");
}

TEST_F(NestingProblemsTest, AsksForAPathBehindAUsedFileThatIsOverridden) {
  EXPECT_EQ(Refusal(TwoStages(), {{"first", "1"}}),
            "-s first: error: 'first' is a file that is used; expected a path in it, first.PATH");
}

}  // namespace nesting_problems_test
}  // namespace oca::loading
