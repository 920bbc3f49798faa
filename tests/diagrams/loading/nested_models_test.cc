// SPDX-License-Identifier: BSD-3-Clause
// Models of files that others use: by the names in each file.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/runs/blind_spots.h"
#include "oca/diagrams/runs/run.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/signals/roles.h"
#include "tests/diagrams/loading/nested_files.h"
#include "tests/diagrams/loading/shipped_files.h"

namespace oca::loading {
namespace nested_models_test {

using shipped_files::kFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// The driver of each connected input, by paths.
std::map<std::string, std::string> Drivers(const Diagram& diagram) {
  std::map<std::string, std::string> drivers;
  for (const Diagram::Leaf& leaf : diagram.systems()) {
    for (const System::InputInfo& input : leaf.system->inputs()) {
      const auto driver = diagram.DriverOf(leaf.system->FindInput(input.name));
      if (driver) drivers[leaf.path + "." + input.name] = diagram.PathOf(*driver);
    }
  }
  return drivers;
}

std::vector<std::string> OthersOf(const LoadedDiagram& loaded, const std::string& distance) {
  std::vector<std::string> others;
  for (const auto& found : loaded.diagram->FindRoles<systems::MeasuresDistances>()) {
    if (found.path != distance) continue;
    for (const auto& other : found.role->others) others.push_back(other.model);
  }
  return others;
}

/// An arm that looks at all others, and two of them that look at each other.
class NestedModelsTest : public nested_files::NestedFiles {
 protected:
  NestedModelsTest() {
    folder.Write("arm.yaml",
                 "systems:\n"
                 "  rest: {type: Constant, value: [0, 0], unit: rad}\n"
                 "  speed: {type: Constant, value: [0, 0], unit: rad/s}\n"
                 "  obstacles: {type: ObstacleSource, obstacles: []}\n"
                 "  kinematics: {type: RobotKinematics, model: arm}\n"
                 "  distance:\n"
                 "    {type: BulletDistance, model: arm, calculate_link_forces: true, others: "
                 "[\"*\"]}\n"
                 "connections:\n"
                 "  - rest.value -> kinematics.position\n"
                 "  - speed.value -> kinematics.velocity\n"
                 "  - kinematics.links -> distance.links\n"
                 "  - obstacles.obstacles -> distance.obstacles\n"
                 "  - inputs.links_<other> -> distance.links_<other>\n"
                 "  - kinematics.links -> outputs.links\n");
    WritePair("arm.yaml");
  }
  void WritePair(const std::string& arm) {
    folder.Write("pair.yaml", Models({"left", "right"}) +
                                  "systems:\n  left: {type: Diagram, file: " + arm +
                                  ", models: {arm: left}}\n  right: {type: Diagram, file: " + arm +
                                  ", models: {arm: right}}\n"
                                  "connections:\n  - <arm>.links -> <other>.links_<arm>\n");
  }
  static std::string Models(const std::vector<std::string>& names) {
    std::string text = "models:\n";
    for (std::size_t i = 0; i < names.size(); ++i) {
      text += fmt::format(
          "  {}: {{urdf: package://planar2/planar2.urdf, base_pose: {{xyz: [{}, 0, 0]}}}}\n",
          names[i], i);
    }
    return text;
  }
  static std::string Cell(const std::string& models = "{}", const std::string& name = "cell") {
    return "  " + name + ": {type: Diagram, file: pair.yaml, models: " + models + "}\n";
  }
};

TEST_F(NestedModelsTest, InputsOfLinksHaveTheNamesOfTheFileTheyAreIn) {
  const LoadedDiagram loaded = Load("systems:\n" + Cell() + Cell("{}", "again"));
  const auto drivers = Drivers(*loaded.diagram);
  EXPECT_EQ(drivers.at("cell.left.distance.links_right"), "cell.right.kinematics.links");
  EXPECT_EQ(drivers.at("again.right.distance.links_left"), "again.left.kinematics.links");
  EXPECT_THAT(OthersOf(loaded, "cell.left.distance"), ElementsAre("cell.right"));
  EXPECT_THAT(OthersOf(loaded, "again.left.distance"), ElementsAre("again.right"));
}

TEST_F(NestedModelsTest, ModelsMayHaveTheSameNamesOrOthersOrBeSwapped) {
  for (const auto& [left, right] :
       {std::pair<std::string, std::string>("left", "right"), {"right", "left"}, {"a", "b"}}) {
    const LoadedDiagram loaded = Load(Models({left, right}) + "systems:\n" +
                                      Cell(fmt::format("{{left: {}, right: {}}}", left, right)));
    const auto drivers = Drivers(*loaded.diagram);
    EXPECT_EQ(drivers.at("cell.left.distance.links_right"), "cell.right.kinematics.links");
    EXPECT_EQ(drivers.at("cell.right.distance.links_left"), "cell.left.kinematics.links");
    EXPECT_THAT(OthersOf(loaded, "cell.left.distance"), ElementsAre(right)) << left;
    EXPECT_THAT(OthersOf(loaded, "cell.right.distance"), ElementsAre(left)) << right;
  }
}

TEST_F(NestedModelsTest, FilesNestThreeDeepWithNamesOfTheirOwn) {
  folder.Write("row.yaml", "systems:\n" + Cell("{left: second, right: first}"));
  const LoadedDiagram loaded = Load(
      Models({"first", "left"}) +
      "systems: {row: {type: Diagram, file: row.yaml, models: {first: left, second: first}}}\n");
  EXPECT_EQ(Drivers(*loaded.diagram).at("row.cell.left.distance.links_right"),
            "row.cell.right.kinematics.links");
  EXPECT_THAT(OthersOf(loaded, "row.cell.left.distance"), ElementsAre("left"));
  EXPECT_THAT(OthersOf(loaded, "row.cell.right.distance"), ElementsAre("first"));
}

TEST_F(NestedModelsTest, AFileBetweenTakesLinksFurtherIn) {
  folder.Write("wrapped.yaml",
               "systems: {inner: {type: Diagram, file: arm.yaml, models: {arm: arm}}}\n"
               "connections:\n"
               "  - inputs.links_<other> -> inner.links_<other>\n"
               "  - inner.links -> outputs.links\n");
  WritePair("wrapped.yaml");
  const LoadedDiagram loaded = Load("systems:\n" + Cell());
  EXPECT_EQ(Drivers(*loaded.diagram).at("cell.left.inner.distance.links_right"),
            "cell.right.inner.kinematics.links");
}

TEST_F(NestedModelsTest, WhatAFileDoesNotLetInIsNotInSightAndIsTold) {
  const std::string more =
      "  third: {type: Diagram, file: arm.yaml, models: {arm: third}}\n"
      "  metrics: {type: MotionMetrics, model: left}\n"
      "connections:\n"
      "  - cell.left.links -> third.links_left\n"
      "  - cell.right.links -> third.links_right\n"
      "  - cell.left.distance.proximities -> metrics.proximities\n";
  const std::string text = Models({"left", "right", "third"}) + "  table: {urdf: " +
                           "package://table_frame/table_frame.urdf}\nsystems:\n" +
                           Cell("{left: left, right: right}") + more;
  const LoadedDiagram loaded = Load(text);
  EXPECT_THAT(OthersOf(loaded, "third.distance"), ElementsAre("left", "right", "table"));
  EXPECT_THAT(OthersOf(loaded, "cell.left.distance"), ElementsAre("right", "table"));
  EXPECT_THAT(
      runs::BlindSpots(loaded),
      Contains("model 'third' (its links do not come into the file of cell.left.distance)"));
}

TEST_F(NestedModelsTest, PairsToIgnoreNameModelsAsTheNearestFileDoes) {
  std::string arm = "{type: BulletDistance, model: arm, ignore: [[planar2_link_1, ";
  folder.Write("arm.yaml",
               "systems:\n"
               "  distance: " +
                   arm +
                   "right/planar2_link_2]]}\n"
                   "connections: [inputs.links -> distance.links, inputs.obstacles -> "
                   "distance.obstacles]\n");
  folder.Write("pair.yaml", Models({"left", "right"}) +
                                "systems:\n"
                                "  rest: {type: Constant, value: [0, 0], unit: rad}\n"
                                "  obstacles: {type: ObstacleSource, obstacles: []}\n"
                                "  kinematics: {type: RobotKinematics, model: left}\n"
                                "  left: {type: Diagram, file: arm.yaml, models: {arm: left}}\n"
                                "connections:\n"
                                "  - rest.value -> kinematics.position\n"
                                "  - kinematics.links -> left.links\n"
                                "  - obstacles.obstacles -> left.obstacles\n");
  const LoadedDiagram loaded =
      Load(Models({"left", "right"}) + "systems:\n" + Cell("{left: right, right: left}"));
  const auto found = loaded.diagram->FindRoles<systems::MeasuresDistances>();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].role->ignored,
              ElementsAre(testing::Pair("planar2_link_1", "left/planar2_link_2")));
}

TEST_F(NestedModelsTest, RefusesAModelWithADotInItsName) {
  EXPECT_THAT(Refusal(Models({"a.b"}) + "systems: {one: {type: Constant, value: 1}}\n"),
              HasSubstr("d.yaml:2:3: error: models.a.b: name; got 'a.b'; expected one without dots "
                        "and slashes"));
}

/// A tree of the file as text of another file.
std::string Flow(const Value& value) {
  std::vector<std::string> items;
  if (value.list() != nullptr) {
    for (const Value& item : *value.list()) items.push_back(Flow(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  if (value.map() == nullptr) return value.null() ? "null" : value.Show();
  for (const Value::Entry& entry : *value.map()) {
    items.push_back(entry.key + ": " + Flow(entry.value));
  }
  return fmt::format("{{{}}}", fmt::join(items, ", "));
}

/// Files that use a shipped one.
class EveryFileNestedTest : public testing::TestWithParam<std::string> {
 protected:
  static LoadedDiagram Alone(const std::string& file) { return LoadDiagram(kFolder / file); }
  /// Its models, each under its name behind all of the prefixes, and a use for each prefix that
  /// takes these; without a prefix, one use that has its own.
  LoadedDiagram Used(const std::string& file, const LoadedDiagram& alone,
                     const std::vector<std::string>& prefixes) {
    const Value* const models = alone.resolved.Find("models");
    std::string given = "models:\n", uses = "systems:\n";
    for (const std::string& prefix : prefixes) {
      std::vector<std::string> names;
      if (models != nullptr) {
        for (const Value::Entry& model : *models->map()) {
          given += fmt::format("  {}{}: {}\n", prefix, model.key, Flow(model.value));
          names.push_back(fmt::format("{}: {}{}", model.key, prefix, model.key));
        }
      }
      uses += Use("use_" + prefix, file, fmt::format("{{{}}}", fmt::join(names, ", ")));
    }
    if (prefixes.empty()) uses += Use("use", file, "{}");
    const std::string run = fmt::format("simulator: {{duration: {}, seed: {}}}\n",
                                        alone.simulator.duration, alone.simulator.seed);
    return LoadDiagram(folder_.Write("d.yaml", run + given + uses));
  }

 private:
  static std::string Use(const std::string& name, const std::string& file,
                         const std::string& models) {
    return fmt::format("  {}: {{type: Diagram, file: {}, models: {}}}\n", name,
                       (kFolder / file).string(), models);
  }
  test::TemporaryFolder folder_;
};

bool Samples(const std::string& file) { return file.find("random_") != std::string::npos; }

std::vector<std::string> FilesThatDoNotSample() {
  std::vector<std::string> files = shipped_files::DiagramFiles();
  std::erase_if(files, Samples);
  return files;
}

TEST_P(EveryFileNestedTest, IsTheSameInEachUseWhateverItsModelsAreCalledThere) {
  const LoadedDiagram alone = Alone(GetParam());
  const auto expected = Drivers(*alone.diagram);
  for (const std::vector<std::string>& prefixes :
       std::vector<std::vector<std::string>>{{}, {""}, {"a_"}, {"b_", "a_"}}) {
    const LoadedDiagram used = Used(GetParam(), alone, prefixes);
    std::map<std::string, std::string> all;
    for (const std::string& prefix : prefixes.empty() ? std::vector<std::string>{""} : prefixes) {
      const std::string path = prefixes.empty() ? "use." : "use_" + prefix + ".";
      for (const auto& [input, output] : expected) all[path + input] = path + output;
    }
    EXPECT_EQ(Drivers(*used.diagram), all);
    const std::size_t uses = std::max<std::size_t>(prefixes.size(), 1);
    EXPECT_EQ(used.expectations.size(), uses * alone.expectations.size());
    EXPECT_EQ(used.warnings.size(), alone.warnings.size())
        << fmt::format("{}", fmt::join(used.warnings, "\n"));
  }
}

INSTANTIATE_TEST_SUITE_P(Diagrams, EveryFileNestedTest, testing::ValuesIn(FilesThatDoNotSample()),
                         shipped_files::TestName);

class FileNestedRunTest : public EveryFileNestedTest {};

/// What judges say, without names of models.
std::vector<std::optional<double>> Numbers(const systems::MotionMetricsValue& value) {
  std::vector<std::optional<double>> numbers;
  for (const systems::Metric& metric : systems::MetricsIn(value)) {
    numbers.push_back(metric.number());
  }
  return numbers;
}

TEST_P(FileNestedRunTest, HasTheMetricsThatItHasAlone) {
  const LoadedDiagram alone = Alone(GetParam());
  const runs::RunOptions short_run{.duration = 1.0, .judge = false};
  const runs::RunResult expected = runs::Run(alone, short_run);
  ASSERT_TRUE(expected.metrics);
  const runs::RunResult result = runs::Run(Used(GetParam(), alone, {"b_", "a_"}), short_run);
  ASSERT_FALSE(result.failure) << result.failure->message;
  ASSERT_EQ(result.judgements.size(), 2 * expected.judgements.size());
  for (std::size_t i = 0; i < result.judgements.size(); ++i) {
    EXPECT_EQ(Numbers(result.judgements[i].metrics),
              Numbers(expected.judgements[i % expected.judgements.size()].metrics))
        << result.judgements[i].judge;
  }
}

INSTANTIATE_TEST_SUITE_P(Diagrams, FileNestedRunTest,
                         testing::Values("dual_arm.yaml", "link_forces_test.yaml",
                                         "scenarios/table_and_frame.yaml", "planar_arm.yaml"),
                         shipped_files::TestName);

}  // namespace nested_models_test
}  // namespace oca::loading
