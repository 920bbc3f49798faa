// SPDX-License-Identifier: BSD-3-Clause
// What is said of files that are used wrongly, or are wrong themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

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
  EXPECT_THAT(refusal, HasSubstr("d.yaml:10:5: error: connections: source: no output port 'valeu'"));
}

TEST_F(NestingProblemsTest, TellsWiringProblemsInTheFileAsItNamesPorts) {
  folder.Write("stage.yaml", std::string(kStage) + "  - lag.out -> gain.in\n");
  EXPECT_EQ(Refusal(TwoStages()),
            "stage.yaml:10:5: error: in first and second: gain.in: two drivers; got this and "
            "inputs.in; expected one");
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

// The robot of the left arm for a third one between them, turned away: one entry of each section.

}  // namespace nesting_problems_test
}  // namespace oca::loading
