// SPDX-License-Identifier: BSD-3-Clause
// Diagram files as systems of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "tests/temporary_folder.h"

namespace oca::loading {
namespace nesting_test {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;
using Overrides = std::vector<files::Override>;

/// A gain of 3 with a lag behind it; lines 4 and 5 are the systems.
const char* const kStage =
    "name: stage\n"
    "parameters: {factor: 3, constant: 0.1}\n"
    "systems:\n"
    "  gain: {type: Gain, gain: \"${factor}\"}\n"
    "  lag: {type: FirstOrderLag, time_constant: \"${constant}\"}\n"
    "connections:\n"
    "  - inputs.in -> gain.in\n"
    "  - gain.out -> lag.in\n"
    "  - lag.out -> outputs.slow\n";

/// Two stages in a row; line 4 is the source, 5 and 6 are the stages.
std::string TwoStages(const std::string& first = "", const std::string& second = "",
                      const std::string& more = "") {
  return "name: row\n"
         "simulator: {duration: 1}\n"
         "systems:\n"
         "  source: {type: Constant, value: [1, 2], unit: rad}\n"
         "  first: {type: Diagram, file: stage.yaml" + first + "}\n"
         "  second: {type: Diagram, file: stage.yaml" + second + "}\n"
         "connections:\n"
         "  - source.value -> first.in\n"
         "  - first.slow -> second.in\n" + more;
}

class NestingTest : public testing::Test {
 protected:
  NestingTest() { folder.Write("stage.yaml", kStage); }

  LoadedDiagram Load(const std::string& text, const Overrides& overrides = {}) {
    return LoadDiagram(folder.Write("d.yaml", text), overrides);
  }
  /// The error text, without the folder; empty if the text loads.
  std::string Refusal(const std::string& text, const Overrides& overrides = {}) {
    try {
      Load(text, overrides);
      return "";
    } catch (const ConfigError& error) {
      return WithoutFolder(error.what());
    }
  }
  std::string WithoutFolder(std::string text) const {
    const std::string place = folder.path().string() + "/";
    for (auto at = text.find(place); at != std::string::npos; at = text.find(place)) {
      text.erase(at, place.size());
    }
    return text;
  }
  static double At(const LoadedDiagram& loaded, const std::string& output) {
    const Context context = loaded.diagram->MakeContext();
    return loaded.diagram->GetOutput<Vector>(output).Eval(context)[0];
  }
  test::TemporaryFolder folder;
};

std::vector<std::string> PathsOf(const LoadedDiagram& loaded) {
  std::vector<std::string> paths;
  for (const auto& block : loaded.systems) paths.push_back(block.name);
  return paths;
}

int Count(const std::string& text, const std::string& what) {
  int count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST_F(NestingTest, MakesTheSystemsOfTheFileBelowTheNameOfTheUse) {
  const LoadedDiagram loaded = Load(TwoStages());
  EXPECT_THAT(PathsOf(loaded),
              ElementsAre("source", "first.gain", "first.lag", "second.gain", "second.lag"));
  const System* const lag = loaded.diagram->FindSystem("second.lag");
  ASSERT_NE(lag, nullptr);
  EXPECT_EQ(loaded.BlockOf(*lag).type, "FirstOrderLag");
  EXPECT_EQ(loaded.diagram->PathOf(*lag), "second.lag");
}

TEST_F(NestingTest, ConnectsPortsOfTheFilesAndGivesOutputsByPortAndByPath) {
  const LoadedDiagram loaded = Load(TwoStages(", parameters: {factor: 5}"));
  EXPECT_EQ(At(loaded, "first.gain.out"), 5.0);
  const auto driver =
      loaded.diagram->DriverOf(loaded.diagram->FindSystem("second.gain")->FindInput("in"));
  ASSERT_TRUE(driver);
  EXPECT_EQ(loaded.diagram->PathOf(*driver), "first.lag.out");
  EXPECT_EQ(loaded.diagram->FindOutput("first.slow"), loaded.diagram->FindOutput("first.lag.out"));
}

TEST_F(NestingTest, ReadsAnyOutputOfAFileByItsPath) {
  std::string text = TwoStages("", "", "  - first.gain.out -> gain.in\n");
  text.insert(text.find("connections:"), "  gain: {type: Gain, gain: 2}\n");
  const LoadedDiagram loaded = Load(text);
  EXPECT_EQ(At(loaded, "gain.out"), 6.0);
}

TEST_F(NestingTest, GivesParametersByMapsOfWhichTheLaterOnesWin) {
  const std::string common = "parameters: {common: {factor: 5, constant: 0.2}, far: 7}\n";
  const LoadedDiagram loaded =
      Load(common + TwoStages(", parameters: [\"${common}\", {factor: \"${far}\"}]",
                              ", parameters: \"${common}\""));
  EXPECT_EQ(At(loaded, "first.gain.out"), 7.0);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const Value* const gain = loaded.systems[3].params.Find("gain");
  ASSERT_NE(gain, nullptr);
  EXPECT_EQ(*gain->integer(), 5);
}

TEST_F(NestingTest, ChoosesIncludedFilesByGivenParameters) {
  folder.Write("part_low.yaml", "systems: {gain: {type: Gain, gain: 2}}\n");
  folder.Write("part_high.yaml", "parameters: {high: 9}\n"
                                 "systems: {gain: {type: Gain, gain: \"${high}\"}}\n");
  folder.Write("stage.yaml", "include: [\"part_${part}.yaml\"]\nparameters: {part: low}\n"
                             "connections: [inputs.in -> gain.in, gain.out -> outputs.slow]\n");
  const LoadedDiagram loaded =
      Load(TwoStages(", parameters: {high: 4}", ", parameters: {part: high, high: 5}"));
  EXPECT_EQ(At(loaded, "first.gain.out"), 2.0);
  EXPECT_EQ(At(loaded, "second.gain.out"), 10.0);
  EXPECT_THAT(loaded.warnings, IsEmpty()) << "another part could have used `high`";
}

TEST_F(NestingTest, RefusesParametersThatTheFileDoesNotHave) {
  const std::string refusal = Refusal(TwoStages(", parameters: {fctor: 5}"));
  EXPECT_EQ(refusal,
            "d.yaml:5:57: error: systems.first.parameters.fctor: stage.yaml has no such parameter; "
            "did you mean 'factor'?");
}

TEST_F(NestingTest, RefusesKeysThatAUseDoesNotHave) {
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

TEST_F(NestingTest, TellsAProblemOfTheFileOnceWithAllItsUses) {
  folder.Write("stage.yaml", std::string(kStage).replace(std::string(kStage).find("Gain"), 4, "Gian"));
  const std::string refusal = Refusal(TwoStages());
  EXPECT_THAT(refusal, HasSubstr("stage.yaml:4:16: error: in first and second: systems.gain.type: no "
                                 "system type 'Gian'; did you mean 'Gain'?"));
  EXPECT_EQ(Count(refusal, "Gian"), 1);
}

TEST_F(NestingTest, CollectsProblemsOfAllFilesAtOnce) {
  const std::string refusal =
      Refusal(TwoStages(", parameters: {constant: -1}", "", "  - source.valeu -> second.out\n"));
  EXPECT_THAT(refusal, HasSubstr("stage.yaml:5:"));
  EXPECT_THAT(refusal, HasSubstr("error: in first: systems.lag.time_constant: got -1"));
  EXPECT_THAT(refusal, HasSubstr("d.yaml:10:5: error: connections: source: no output 'valeu'"));
}

TEST_F(NestingTest, TellsWiringProblemsInTheFileAsItNamesPorts) {
  folder.Write("stage.yaml", std::string(kStage) + "  - lag.out -> gain.in\n");
  EXPECT_EQ(Refusal(TwoStages()),
            "stage.yaml:10:5: error: in first and second: gain.in: two drivers; got this and "
            "inputs.in; expected one");
  std::string stage = std::string(kStage) + "  - gain.out -> sum.in0\n";
  stage.insert(stage.find("connections:"), "  sum: {type: Sum, signs: [1, 1]}\n");
  folder.Write("stage.yaml", stage);
  EXPECT_THAT(Refusal(TwoStages()),
              HasSubstr("stage.yaml:6:3: error: in first and second: sum.in1: input not connected"));
}

TEST_F(NestingTest, TellsOfAnInputThatTheOtherFileLeavesOpenWhereTheUseStands) {
  std::string text = TwoStages();
  text.erase(text.find("  - first.slow"));
  EXPECT_THAT(Refusal(text),
              AllOf(HasSubstr("d.yaml:6:3: error: second.in: second.gain.in: input not connected"),
                    Not(HasSubstr("first"))));
}

TEST_F(NestingTest, RefusesAFileThatUsesItselfAndNamesTheChain) {
  folder.Write("a.yaml", "systems: {b: {type: Diagram, file: b.yaml}}\n");
  folder.Write("b.yaml", "systems: {a: {type: Diagram, file: a.yaml}}\n");
  EXPECT_THAT(Refusal("systems: {a: {type: Diagram, file: a.yaml}}\n"),
              AllOf(HasSubstr("b.yaml:1:36: error: in a.b: systems.a.file: "),
                    HasSubstr("uses itself: a.yaml -> b.yaml -> a.yaml")));
}

TEST_F(NestingTest, NestsToAnyDepth) {
  folder.Write("pair.yaml",
               "parameters: {factor: 2}\n"
               "systems:\n"
               "  one: {type: Diagram, file: stage.yaml, parameters: {factor: \"${factor}\"}}\n"
               "  two: {type: Diagram, file: stage.yaml}\n"
               "connections: [inputs.in -> one.in, one.slow -> two.in, two.slow -> outputs.slow]\n");
  std::string text = TwoStages(", parameters: {factor: 4}");
  text.replace(text.find("stage.yaml"), 10, "pair.yaml");
  const LoadedDiagram loaded = Load(text, {{"first.two.parameters.factor", "8"}});
  EXPECT_EQ(At(loaded, "first.one.gain.out"), 4.0);
  const auto driver =
      loaded.diagram->DriverOf(loaded.diagram->FindSystem("second.gain")->FindInput("in"));
  ASSERT_TRUE(driver);
  EXPECT_EQ(loaded.diagram->PathOf(*driver), "first.two.lag.out");
  ASSERT_EQ(loaded.systems[3].name, "first.two.gain");
  EXPECT_EQ(*loaded.systems[3].params.Find("gain")->integer(), 8);
}

TEST_F(NestingTest, OverridesBehindTheNameOfAUseAreOfItsFile) {
  const LoadedDiagram loaded = Load(
      TwoStages(), {{"first.parameters.factor", "4"}, {"second.systems.lag.time_constant", "0.5"}});
  EXPECT_EQ(At(loaded, "first.gain.out"), 4.0);
  EXPECT_EQ(*loaded.systems[3].params.Find("gain")->integer(), 3);
  double constant = 0.0;
  EXPECT_TRUE(loaded.systems[4].params.Find("time_constant")->number(constant));
  EXPECT_EQ(constant, 0.5);
  const LoadedDiagram all = Load(TwoStages(), {{"*.parameters.factor", "7"}});
  EXPECT_EQ(*all.systems[1].params.Find("gain")->integer(), 7);
  EXPECT_EQ(*all.systems[3].params.Find("gain")->integer(), 7);
}

TEST_F(NestingTest, OverridesOfTheEntryGiveOtherParameters) {
  const Overrides overrides{{"systems.first.parameters.factor", "6"}};
  EXPECT_EQ(At(Load(TwoStages(), overrides), "first.gain.out"), 6.0);
  EXPECT_EQ(At(Load(TwoStages(", parameters: {factor: 2}"), overrides), "first.gain.out"), 6.0);
}

TEST_F(NestingTest, NamesAnOverrideThatLeadsNowhereAsItWasGiven) {
  EXPECT_THAT(Refusal(TwoStages(), {{"first.parameters.fctor", "4"}}),
              AllOf(HasSubstr("-s first.parameters.fctor: error: in first: no 'fctor' there"),
                    HasSubstr("did you mean 'factor'?")));
  EXPECT_THAT(Refusal(TwoStages(), {{"frist.parameters.factor", "4"}}),
              HasSubstr("no 'frist' there; did you mean 'first'?"));
}

TEST_F(NestingTest, RecordsWhatTheFileRecordsAndWhatTheOtherAdds) {
  folder.Write("stage.yaml", std::string(kStage) + "record: {signals: {lag.out: 10}}\n");
  const LoadedDiagram loaded =
      Load(TwoStages() + "record: {signals: {second.lag.out: 20, \"*.gain.out\": 5, first.slow: 4}}\n");
  std::vector<std::string> names;
  for (const auto& signal : loaded.record) {
    names.push_back(signal.name + " " + std::to_string(signal.period.denominator()));
  }
  EXPECT_THAT(names, ElementsAre("second.lag.out 20", "first.gain.out 5", "second.gain.out 5",
                                 "first.slow 4", "first.lag.out 10"));
}

TEST_F(NestingTest, ExpectsWhatTheFileExpectsUnlessTheOtherSaysOtherwise) {
  folder.Write("stage.yaml",
               std::string(kStage) + "expect: {\"lag.out[0]\": {at_least: 100}}\n");
  const LoadedDiagram loaded =
      Load(TwoStages() + "expect: {\"first.lag.out[0]\": {equal: 3, within: 0.1}}\n");
  const runs::RunResult result = runs::Run(loaded, {});
  ASSERT_EQ(result.expectations.size(), 2u);
  EXPECT_EQ(result.expectations[0].name, "first.lag.out[0]");
  EXPECT_TRUE(result.expectations[0].ok);
  EXPECT_EQ(result.expectations[1].name, "second.lag.out[0]");
  EXPECT_FALSE(result.expectations[1].ok);
}

TEST_F(NestingTest, KeepsTolerancesOfTheFileUnlessTheOtherHasThem) {
  folder.Write("stage.yaml", std::string(kStage) +
                                 "simulator_tolerances: {lag: {relative: 1.0e-4, absolute: 1.0e-5}}\n");
  const LoadedDiagram loaded =
      Load(TwoStages() + "simulator_tolerances: {second.lag: {relative: 1.0e-7}}\n");
  const auto& tolerances = loaded.simulator.integration.tolerances;
  EXPECT_EQ(tolerances.at("first.lag").relative, 1e-4);
  EXPECT_EQ(tolerances.at("second.lag").relative, 1e-7);
  EXPECT_EQ(tolerances.at("second.lag").absolute, 1e-5);
}

TEST_F(NestingTest, BuildsAPartThatIsInsideOfAUse) {
  const Blueprint blueprint(folder.Write("d.yaml", TwoStages()));
  const auto part = [&](std::vector<std::string> names) {
    const LoadedDiagram loaded = blueprint.Build({}, {.part = std::move(names)});
    std::vector<std::string> ports;
    for (const auto& input : loaded.diagram->exported_inputs()) ports.push_back(input.name);
    for (const auto& output : loaded.diagram->exported_outputs()) ports.push_back(output.first);
    return ports;
  };
  EXPECT_THAT(part({"second"}),
              ElementsAre("first_lag_out", "second_gain_out", "second_lag_out"));
  EXPECT_THAT(part({"first.lag", "second.gain"}),
              UnorderedElementsAre("first_gain_out", "first_lag_out", "second_gain_out"));
  EXPECT_THAT([&] { part({"first.gian"}); },
              testing::ThrowsMessage<ConfigError>(
                  HasSubstr("part: no system 'first.gian'; did you mean 'first.gain'?")));
}

TEST_F(NestingTest, AFileAloneHasThePortsThatItsConnectionsName) {
  const LoadedDiagram loaded = LoadDiagram(folder.path() / "stage.yaml");
  ASSERT_EQ(loaded.diagram->exported_inputs().size(), 1u);
  EXPECT_EQ(loaded.diagram->exported_inputs()[0].name, "in");
  EXPECT_EQ(loaded.diagram->FindOutput("slow"), loaded.diagram->FindOutput("lag.out"));
}

TEST_F(NestingTest, RefusesPortsThatTheFileDoesNotName) {
  EXPECT_THAT(Refusal(TwoStages("", "", "  - source.value -> first.gain\n")),
              AllOf(HasSubstr("d.yaml:10:5: error: connections: first: no input 'gain' of "),
                    HasSubstr("its inputs are: in")));
  EXPECT_THAT(Refusal(TwoStages("", "", "  - first.slwo -> gain.in\n")),
              HasSubstr("did you mean 'slow'?"));
  EXPECT_THAT(Refusal("systems: {inputs: {type: Gain}}\n"),
              HasSubstr("systems.inputs: stands for the ports of the file"));
}

TEST_F(NestingTest, MakesEveryConnectionThatAPatternStandsFor) {
  folder.Write("cell.yaml",
               "systems: {sum: {type: Sum, signs: [1, 1]}, lag: {type: FirstOrderLag, "
               "time_constant: 1}}\n"
               "connections:\n"
               "  - inputs.in<n> -> sum.in<n>\n"
               "  - sum.out -> lag.in\n"
               "  - lag.out -> outputs.out\n");
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: 1}\n"
      "  a: {type: Diagram, file: cell.yaml}\n"
      "  b: {type: Diagram, file: cell.yaml}\n"
      "connections:\n"
      "  - source.value -> <cell>.in0\n"
      "  - <cell>.out -> <other>.in1\n";
  const LoadedDiagram loaded = Load(text);
  const auto driver = [&](const std::string& input) {
    const auto dot = input.rfind('.');
    const System* const system = loaded.diagram->FindSystem(input.substr(0, dot));
    return loaded.diagram->PathOf(
        *loaded.diagram->DriverOf(system->FindInput(input.substr(dot + 1))));
  };
  EXPECT_EQ(driver("a.sum.in0"), "source.value");
  EXPECT_EQ(driver("a.sum.in1"), "b.lag.out");
  EXPECT_EQ(driver("b.sum.in1"), "a.lag.out");
  const LoadedDiagram none = Load(text + "  - <cell>.nothing -> <other>.in1\n");
  ASSERT_EQ(none.warnings.size(), 1u);
  EXPECT_THAT(WithoutFolder(none.warnings[0]),
              HasSubstr("d.yaml:8:5: warning: connections: <cell>.nothing -> <other>.in1: no ports "
                        "have such names"));
}

TEST_F(NestingTest, AConnectionThatIsSaidAgainCountsOnce) {
  folder.Write("stage.yaml", std::string(kStage) + "  - gain.out -> lag.in\n");
  EXPECT_EQ(Refusal(TwoStages()), "");
}

/// A robot's kinematics at rest.
const char* const kArm =
    "models: {arm: {urdf: package://planar2/planar2.urdf, acceleration_limits: 7}}\n"
    "systems:\n"
    "  rest: {type: Constant, value: [0, 0], unit: rad}\n"
    "  kinematics: {type: RobotKinematics, model: arm}\n"
    "connections: [rest.value -> kinematics.position, kinematics.links -> outputs.links]\n";

std::string TwoArms(const std::string& right = "{arm: right}") {
  return "models:\n"
         "  left: {urdf: package://planar2/planar2.urdf}\n"
         "  right: {urdf: package://planar2/planar2.urdf, base_pose: {xyz: [1, 0, 0]}, "
         "acceleration_limits: 9}\n"
         "systems:\n"
         "  left: {type: Diagram, file: arm.yaml, models: {arm: left}}\n"
         "  right: {type: Diagram, file: arm.yaml, models: " + right + "}\n";
}

TEST_F(NestingTest, TakesModelsOfTheOtherFileWithLimitsThatTheyLack) {
  folder.Write("arm.yaml", kArm);
  const LoadedDiagram loaded = Load(TwoArms());
  std::vector<std::string> names;
  for (const auto& [name, model] : loaded.models.all()) names.push_back(name);
  EXPECT_THAT(names, ElementsAre("left", "right"));
  EXPECT_EQ(loaded.models.Get("left")->acceleration_limits()[0], 7.0);
  EXPECT_EQ(loaded.models.Get("right")->acceleration_limits()[0], 9.0);
  EXPECT_EQ(loaded.models.Get("right")->X_WB().translation().x(), 1.0);
  EXPECT_EQ(loaded.systems[1].models->FullName("arm"), "left");
}

TEST_F(NestingTest, AModelOfItsOwnHasAFullNameBelowTheUse) {
  folder.Write("arm.yaml", kArm);
  const LoadedDiagram loaded = Load(TwoArms("{}"));
  std::vector<std::string> names;
  for (const auto& [name, model] : loaded.models.all()) names.push_back(name);
  EXPECT_THAT(names, ElementsAre("left", "right", "right.arm"));
}

TEST_F(NestingTest, RefusesModelsThatThereAreNot) {
  folder.Write("arm.yaml", kArm);
  EXPECT_THAT(Refusal(TwoArms("{arm: rihgt}")),
              AllOf(HasSubstr("d.yaml:6:"),
                    HasSubstr("systems.right.models.arm: model: got 'rihgt'; expected one of: left, "
                              "right; did you mean 'right'?")));
  folder.Write("arm.yaml", std::string(kArm).substr(std::string(kArm).find("systems")));
  EXPECT_THAT(Refusal(TwoArms("{}")),
              HasSubstr("arm.yaml:3:15: error: in right: systems.kinematics: model: got 'arm'; "
                        "expected one of: (the file has no models)"));
  EXPECT_THAT(WithoutFolder(Load(TwoArms("{arm: right, amr: left}")).warnings.at(0)),
              HasSubstr("warning: systems.right.models.amr: nothing in arm.yaml uses it"));
}

TEST_F(NestingTest, ReadsAFileOnceForAllUsesAndBuilds) {
  const Blueprint blueprint(folder.Write("d.yaml", TwoStages()));
  const LoadedDiagram first = blueprint.Build();
  folder.Write("stage.yaml", "systems: {}\n");  // nobody looks at it again
  const LoadedDiagram again = blueprint.Build({{"second.parameters.factor", "6"}});
  EXPECT_EQ(At(again, "first.gain.out"), 3.0);
  EXPECT_EQ(*again.systems[3].params.Find("gain")->integer(), 6);
  EXPECT_THAT(first.sources, Contains(std::filesystem::canonical(folder.path() / "stage.yaml")));
}

TEST_F(NestingTest, RefusesAFileThatDrawsScenarios) {
  folder.Write("stage.yaml", std::string(kStage) + "sampling: {draw: {factor: {uniform: [1, 2]}}}\n");
  EXPECT_THAT(Refusal(TwoStages()),
              HasSubstr("in first and second: sampling: got a file that draws scenarios"));
}

// The robot of the left arm for a third one between them, turned away: one entry of each section.
TEST_F(NestingTest, ThreeArmsAreOneEntryMoreOfModelsAndSystems) {
  const std::string file = OCA_SOURCE_DIR "/diagrams/dual_arm.yaml";
  const std::string third =
      "include: [" + file + "]\n"
      "models: {third: {urdf: package://lwr4/lwr4.urdf, srdf: package://lwr4/lwr4.srdf, base_pose: "
      "{xyz: [1.2, 0, 0.85]}}}\n"
      "systems: {third: {type: Diagram, file: " OCA_SOURCE_DIR "/diagrams/parts/arm_loop.yaml, "
      "models: {arm: third}, parameters: \"${each}\"}}\n";
  const LoadedDiagram loaded = Load(third);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  for (const char* arm : {"left", "right", "third"}) {
    for (const char* other : {"left", "right", "third"}) {
      if (arm == std::string(other)) continue;
      const auto driver = loaded.diagram->DriverOf(
          loaded.diagram->FindSystem(arm + std::string(".distance"))
              ->FindInput(std::string("links_") + other));
      ASSERT_TRUE(driver) << arm << " " << other;
      EXPECT_EQ(loaded.diagram->PathOf(*driver), other + std::string(".kinematics.links"));
    }
  }
  EXPECT_FALSE(runs::Run(loaded, {.duration = 0.1}).failure);
}

}  // namespace nesting_test
}  // namespace oca::loading
