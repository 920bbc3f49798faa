// SPDX-License-Identifier: BSD-3-Clause
// Diagram files as systems of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/csv.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/loading/nested_files.h"

namespace oca::loading {
namespace nesting_test {

using nested_files::kStage;
using nested_files::Overrides;
using nested_files::TwoStages;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class NestingTest : public nested_files::NestedFiles {};

std::vector<std::string> PathsOf(const LoadedDiagram& loaded) {
  std::vector<std::string> paths;
  for (const auto& block : loaded.systems) paths.push_back(block.name);
  return paths;
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
  folder.Write("part_high.yaml",
               "parameters: {high: 9}\n"
               "systems: {gain: {type: Gain, gain: \"${high}\"}}\n");
  folder.Write("stage.yaml",
               "include: [\"part_${part}.yaml\"]\nparameters: {part: low}\n"
               "connections: [inputs.in -> gain.in, gain.out -> outputs.slow]\n");
  const LoadedDiagram loaded =
      Load(TwoStages(", parameters: {high: 4}", ", parameters: {part: high, high: 5}"));
  EXPECT_EQ(At(loaded, "first.gain.out"), 2.0);
  EXPECT_EQ(At(loaded, "second.gain.out"), 10.0);
  EXPECT_THAT(loaded.warnings, IsEmpty()) << "another part could have used `high`";
}

TEST_F(NestingTest, NestsToAnyDepth) {
  folder.Write(
      "pair.yaml",
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

TEST_F(NestingTest, RecordsWhatTheFileRecordsAndWhatTheOtherAdds) {
  folder.Write("stage.yaml", std::string(kStage) + "record: {signals: {lag.out: 10}}\n");
  const LoadedDiagram loaded = Load(
      TwoStages() + "record: {signals: {second.lag.out: 20, \"*.gain.out\": 5, first.slow: 4}}\n");
  std::vector<std::string> names;
  for (const auto& signal : loaded.record) {
    names.push_back(signal.name + " " + std::to_string(signal.period.denominator()));
  }
  EXPECT_THAT(names, ElementsAre("second.lag.out 20", "first.gain.out 5", "second.gain.out 5",
                                 "first.slow 4", "first.lag.out 10"));
}

TEST_F(NestingTest, ExpectsWhatTheFileExpectsUnlessTheOtherSaysOtherwise) {
  folder.Write("stage.yaml", std::string(kStage) + "expect: {\"lag.out[0]\": {at_least: 100}}\n");
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
  folder.Write(
      "stage.yaml",
      std::string(kStage) + "simulator_tolerances: {lag: {relative: 1.0e-4, absolute: 1.0e-5}}\n");
  const LoadedDiagram loaded =
      Load(TwoStages() + "simulator_tolerances: {second.lag: {relative: 1.0e-7}}\n");
  const auto& tolerances = loaded.simulator.integration.tolerances;
  EXPECT_EQ(tolerances.at("first.lag").relative, 1e-4);
  EXPECT_EQ(tolerances.at("second.lag").relative, 1e-7);
  EXPECT_EQ(tolerances.at("second.lag").absolute, 1e-5);
}

TEST_F(NestingTest, WritesTablesByTheWholePathWithColumnsByThePort) {
  const LoadedDiagram loaded = Load(TwoStages() + "record: {signals: {\"*.gain.out\": 1}}\n");
  runs::Csv csv(folder.path() / "tables");
  EXPECT_FALSE(runs::Run(loaded, {.outputs = {&csv}}).failure);
  std::ifstream table(folder.path() / "tables" / "second.gain.out.csv");
  std::string header;
  std::getline(table, header);
  EXPECT_EQ(header, "time,out[0],out[1]");
}

TEST_F(NestingTest, AFileAloneHasThePortsThatItsConnectionsName) {
  const LoadedDiagram loaded = LoadDiagram(folder.path() / "stage.yaml");
  ASSERT_EQ(loaded.diagram->exported_inputs().size(), 1u);
  EXPECT_EQ(loaded.diagram->exported_inputs()[0].name, "in");
  EXPECT_EQ(loaded.diagram->FindOutput("slow"), loaded.diagram->FindOutput("lag.out"));
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
         "  right: {type: Diagram, file: arm.yaml, models: " +
         right + "}\n";
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
  EXPECT_THAT(
      Refusal(TwoArms("{arm: rihgt}")),
      AllOf(HasSubstr("d.yaml:6:"),
            HasSubstr("systems.right.models.arm: model: got 'rihgt'; expected one of: left, "
                      "right; did you mean 'right'?")));
  folder.Write("arm.yaml", std::string(kArm).substr(std::string(kArm).find("systems")));
  EXPECT_THAT(Refusal(TwoArms("{}")),
              HasSubstr("arm.yaml:3:46: error: in right: systems.kinematics: model: got 'arm'; "
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

TEST_F(NestingTest, ThreeArmsAreOneLineMoreOfModelsAndOfSystems) {
  const std::string file = OCA_SOURCE_DIR "/diagrams/dual_arm.yaml";
  const std::string third =
      "include: [" + file +
      "]\n"
      "models: {third: {urdf: package://lwr4/lwr4.urdf, srdf: package://lwr4/lwr4.srdf, base_pose: "
      "{xyz: [1.2, 0, 0.85]}}}\n"
      "systems: {third: {type: Diagram, file: " OCA_SOURCE_DIR
      "/diagrams/parts/sweeping_arm.yaml, "
      "models: {arm: third}, parameters: [\"${each}\", {side: 1}]}}\n";
  const LoadedDiagram loaded = Load(third);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  for (const char* arm : {"left", "right", "third"}) {
    for (const char* other : {"left", "right", "third"}) {
      if (arm == std::string(other)) continue;
      const auto driver =
          loaded.diagram->DriverOf(loaded.diagram->FindSystem(arm + std::string(".distance"))
                                       ->FindInput(std::string("links_") + other));
      ASSERT_TRUE(driver) << arm << " " << other;
      EXPECT_EQ(loaded.diagram->PathOf(*driver), other + std::string(".kinematics.links"));
    }
  }
  EXPECT_FALSE(runs::Run(loaded, {.duration = 0.1}).failure);
}

}  // namespace nesting_test
}  // namespace oca::loading
