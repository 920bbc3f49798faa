// SPDX-License-Identifier: BSD-3-Clause
// A Build gives what a load gives, and reads nothing that was read.
#include "oca/diagrams/loading/blueprint.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/loading/shipped_files.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/temporary_folder.h"

namespace oca::loading {
namespace blueprint_test {

namespace fs = std::filesystem;
using files::Override;
using shipped_files::DiagramFiles;
using shipped_files::kFolder;
using shipped_files::TestName;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Overrides = std::vector<Override>;

/// A tree with the place of every node.
std::string Text(const Value& value) {
  std::string text = value.location().ToString() + " ";
  if (value.list() != nullptr) {
    for (const Value& item : *value.list()) text += "- " + Text(item);
  } else if (value.map() != nullptr) {
    for (const Value::Entry& entry : *value.map()) {
      text += entry.location.ToString() + " " + entry.key + ": " + Text(entry.value);
    }
  } else {
    text += value.Show();
  }
  return text + "\n";
}

/// Everything that a diagram is, from its files to the first values of all outputs.
std::vector<std::string> Everything(const LoadedDiagram& loaded) {
  std::vector<std::string> all{loaded.file, loaded.name, loaded.description, Text(loaded.document),
                               Text(loaded.resolved)};
  for (const auto* paths : {&loaded.sources, &loaded.candidates, &loaded.opened}) {
    for (const fs::path& path : *paths) all.push_back(path.string());
    all.emplace_back();
  }
  all.insert(all.end(), loaded.warnings.begin(), loaded.warnings.end());
  all.push_back(std::to_string(loaded.scenario.tries));
  for (const auto& signal : loaded.record) all.push_back(signal.name);
  for (const auto& expectation : loaded.expectations) all.push_back(expectation.name);
  const Context start = loaded.diagram->MakeContext();
  const bool closed = loaded.diagram->exported_inputs().empty();
  for (const Diagram::Leaf& leaf : loaded.diagram->systems()) {
    const LoadedDiagram::Block& block = loaded.BlockOf(*leaf.system);
    all.push_back(leaf.path + " " + block.type + " " + Text(block.params));
    for (const System::OutputInfo& output : leaf.system->outputs()) {
      std::string value = leaf.path + "." + output.name + " ";
      if (closed) EvalJson(leaf.system->FindOutput(output.name), start, value);
      all.push_back(value);
    }
  }
  return all;
}

std::string RefusalOf(const std::function<void()>& load) {
  try {
    load();
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

class EveryBlueprintTest : public testing::TestWithParam<std::string> {};

TEST_P(EveryBlueprintTest, BuildsWhatALoadGives) {
  const fs::path file = kFolder / GetParam();
  const Blueprint blueprint(file);
  const std::vector<Overrides> variations{
      {}, {{"simulator.seed", "7"}, {"simulator.duration", "3"}}, {}};
  for (const Overrides& overrides : variations) {
    std::vector<std::string> built, fresh;
    const std::string refused = RefusalOf([&] { built = Everything(blueprint.Build(overrides)); });
    EXPECT_EQ(refused, RefusalOf([&] { fresh = Everything(LoadDiagram(file, overrides)); }));
    EXPECT_EQ(built, fresh);
  }
}

INSTANTIATE_TEST_SUITE_P(Diagrams, EveryBlueprintTest, testing::ValuesIn(DiagramFiles()), TestName);

/// Overrides that change which files are read, or what of them.
TEST(BlueprintTest, BuildsWhatALoadGivesWhateverAnOverrideChanges) {
  const fs::path file = kFolder / "static_test.yaml";
  const Blueprint blueprint(file);
  const std::vector<Overrides> variations{
      {},
      {{"parameters.arm_meshes", "true"}},
      {{"parameters.avoidance", "safety_filter"}},
      {{"parameters.avoidance", "vortex"}, {"parameters.rate", "50"}},
      {{"models.arm.base_pose.xyz", "[0.1, 0, 0.85]"}},
      {{"models.arm.base_pose.rpy", "[0, 0, 1]"}, {"parameters.arm_meshes", "true"}},
      {{"models.arm.acceleration_limits", "3"}},
      {{"models.arm.collision", "decomposition"}, {"parameters.arm_meshes", "true"}},
      {{"models.arm.attached",
        "[{id: tool, link: lwr4_link_7, shape: {type: sphere, radius: 1}}]"}},
      {{"models.arm.urdf", "package://ur5e/ur5e.urdf"}},
      {{"models.arm.urdf", "nowhere.urdf"}},
      {{"packages.lwr4", (kFolder.parent_path() / "models/robots/ur5e").string()}},
      {{"parameters.avoidance", "nonsense"}},
      {{"parameters.test_joint_factor", "${1 +}"}},
      {{"parameters.rate", "-1"}, {"systems.field.kind", "7"}, {"nothing", "1"}},
      {{"systems.obstacles.obstacles.0.shape",
        "{type: cloud, file: package://scan/scan.xyz, radius: 0.02}"}},
      {{"systems.obstacles.obstacles.0.shape",
        "{type: cloud, file: package://scan/scan.xyz, radius: 0.03}"}},
      {{"parameters.rate", "1.0e+2"}},
      {{"parameters.rate", "010"}},
      {}};
  int refusals = 0;
  for (const Overrides& overrides : variations) {
    std::vector<std::string> built, fresh;
    const std::string refused = RefusalOf([&] { built = Everything(blueprint.Build(overrides)); });
    EXPECT_EQ(refused, RefusalOf([&] { fresh = Everything(LoadDiagram(file, overrides)); }));
    EXPECT_EQ(built, fresh);
    refusals += refused.empty() ? 0 : 1;
  }
  EXPECT_EQ(refusals, 7);
}

/// Parameters that the file gives to those that it uses, and parameters of these alone.
TEST(BlueprintTest, BuildsWhatALoadGivesOfFilesThatAreUsed) {
  const fs::path file = kFolder / "dual_arm.yaml";
  const Blueprint blueprint(file);
  const std::vector<Overrides> variations{
      {},
      {{"parameters.max_distance", "0.3"}},
      {{"parameters.max_distance", "0.35"}, {"left.parameters.start.1", "0.9"}},
      {{"left.parameters.reach", "[0, 0, 0, 0, 0, 0, 0]"}},
      {{"right.systems.plant.initial_position", "${reach}"}},
      {{"models.left.base_pose.xyz.1", "0.5"}},
      {{"parameters.avoidance", "vortex"}},
      {{"parameters.rate", "-3"}},
      {}};
  for (const Overrides& overrides : variations) {
    std::vector<std::string> built, fresh;
    const std::string refused = RefusalOf([&] { built = Everything(blueprint.Build(overrides)); });
    EXPECT_EQ(refused, RefusalOf([&] { fresh = Everything(LoadDiagram(file, overrides)); }));
    EXPECT_EQ(built, fresh);
  }
}

TEST(BlueprintTest, DrawsEachSeedAsALoadDoes) {
  const fs::path file = kFolder / "scenarios/random_static.yaml";
  const Blueprint blueprint(file);
  for (const char* const seed : {"1", "2", "3", "1"}) {
    EXPECT_EQ(Everything(blueprint.Build({{"simulator.seed", seed}})),
              Everything(LoadDiagram(file, {{"simulator.seed", seed}})));
  }
}

/// A robot and an obstacle of meshes, a part that is chosen and a table, all in one folder.
class OwnFilesTest : public testing::Test {
 protected:
  OwnFilesTest() {
    folder_.Write("files/d.yaml", R"(
name: own
include: ["part_${kind}.yaml"]
parameters: {kind: a, height: 1, unused: 1}
simulator: {duration: 1}
packages: {mine: .}
models:
  arm: {urdf: package://mine/arm.urdf}
systems:
  obstacles:
    type: ObstacleSource
    obstacles:
      - {id: angle, shape: {type: mesh, file: angle.obj}, pose: {xyz: [0, 0, "${height}"]}}
      - id: cut
        shape: {type: mesh, file: package://mine/angle.obj, collision: decomposition}
        pose: {xyz: [3, 0, 0]}
      - id: ground
        shape: {type: heightmap, file: ground.csv, cell: 0.5, scale: 1}
        pose: {xyz: [0, 0, -3]}
      - {id: dots, shape: {type: cloud, file: dots.xyz, radius: 0.1}, pose: {xyz: [9, 0, 0]}}
      - {id: mover, shape: {type: sphere, radius: 0.1}, motion: {type: csv, file: way.csv}}
  spline: {type: SplineGenerator, file: points.csv, period: 0.01}
)");
    folder_.Write("files/part_a.yaml",
                  "parameters: {gain: 2}\nsystems: {c: {type: Constant, "
                  "value: \"${gain * 3}\"}}\n");
    folder_.Write("files/part_b.yaml", "systems: {c: {type: Constant, value: 5}}\n");
    folder_.Write("files/arm.urdf", R"(<robot name="arm"><link name="base"/>
<link name="link"><collision><geometry><mesh filename="pyramid.obj"/></geometry></collision>
<visual><geometry><mesh filename="pyramid.obj"/></geometry></visual></link>
<joint name="joint" type="revolute"><parent link="base"/><child link="link"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>)");
    folder_.Write("files/angle.obj", geometry::AngleObj());
    folder_.Write("files/pyramid.obj", geometry::TextObj());
    folder_.Write("files/ground.csv", "0,0.5\n0.25,0\n");
    folder_.Write("files/dots.xyz", "0 0 0\n1 0 0\n");
    folder_.Write("files/way.csv", "time,x,y,z\n0,5,0,0\n1,6,0,0\n");
    folder_.Write("files/points.csv", "time,p1\n0,0\n1,0.5\n");
  }
  fs::path file() const { return folder_.path() / "files/d.yaml"; }
  test::TemporaryFolder folder_;
};

TEST_F(OwnFilesTest, ABuildReadsNothingThatWasRead) {
  const Blueprint blueprint(file());
  const Overrides other{{"parameters.height", "2"}, {"systems.spline.period", "0.02"}};
  const Overrides placed{{"models.arm.base_pose.xyz", "[0, 0, 1]"}};
  const Overrides limited{{"models.arm.acceleration_limits", "3"}};
  const Overrides thicker{{"systems.obstacles.obstacles.3.shape.radius", "0.2"},
                          {"systems.obstacles.obstacles.2.shape.cell", "0.7"}};
  std::vector<std::vector<std::string>> fresh;
  for (const Overrides& overrides : {other, placed, limited, thicker}) {
    fresh.push_back(Everything(LoadDiagram(file(), overrides)));
  }
  blueprint.Build();
  fs::remove_all(folder_.path() / "files");
  EXPECT_EQ(Everything(blueprint.Build(other)), fresh[0]);
  EXPECT_EQ(Everything(blueprint.Build(placed)), fresh[1]);
  EXPECT_EQ(Everything(blueprint.Build(limited)), fresh[2]);
  EXPECT_EQ(Everything(blueprint.Build(thicker)), fresh[3]);
  EXPECT_THAT(RefusalOf([&] {
                blueprint.Build({{"parameters.kind", "c"}});
              }),
              HasSubstr("part_c.yaml: error: cannot be read"));
  EXPECT_THAT(RefusalOf([&] { LoadDiagram(file(), other); }), HasSubstr("cannot be read"));
}

TEST_F(OwnFilesTest, HoldsFilesAsTheyWereReadAndReadsThoseThatAnOverrideBringsIn) {
  const Blueprint blueprint(file());
  const auto value = [](const LoadedDiagram& loaded) {
    return loaded.diagram->GetOutput<Vector>("c.value").Eval(loaded.diagram->MakeContext())[0];
  };
  EXPECT_EQ(value(blueprint.Build()), 6.0);
  folder_.Write("files/part_a.yaml", "systems: {c: {type: Constant, value: 8}}\n");
  EXPECT_EQ(value(blueprint.Build({{"parameters.height", "2"}})), 6.0);
  EXPECT_EQ(value(LoadDiagram(file())), 8.0);
  EXPECT_EQ(value(blueprint.Build({{"parameters.kind", "b"}})), 5.0);
  EXPECT_EQ(value(blueprint.Build({{"parameters.kind", "a"}})), 6.0);
  const Blueprint copy = blueprint;
  EXPECT_EQ(value(copy.Build()), 6.0);
  EXPECT_EQ(value(Blueprint(file()).Build()), 8.0);
}

TEST_F(OwnFilesTest, TriesAgainWhatCouldNotBeRead) {
  const Blueprint blueprint(folder_.path() / "files/later.yaml");
  EXPECT_THAT(RefusalOf([&] { blueprint.Build(); }), HasSubstr("cannot be read"));
  folder_.Write("files/later.yaml", "systems: {c: {type: Constant, value: 1}}\n");
  EXPECT_EQ(blueprint.Build().systems.size(), 1u);
}

TEST_F(OwnFilesTest, SharesRobotsThatAreTheSameAndNothingElse) {
  const Blueprint blueprint(file());
  const LoadedDiagram one = blueprint.Build();
  const LoadedDiagram two = blueprint.Build({{"parameters.height", "2"}});
  const LoadedDiagram moved = blueprint.Build({{"models.arm.base_pose.xyz", "[0, 0, 1]"}});
  EXPECT_EQ(one.models.Get("arm"), two.models.Get("arm"));
  EXPECT_NE(one.models.Get("arm"), moved.models.Get("arm"));
  const auto hull = [](const LoadedDiagram& loaded) {
    const auto& link = loaded.models.Get("arm")->links()[1];
    return std::get<geometry::ConvexMesh>(link.collisions[0].shape).hull;
  };
  EXPECT_EQ(hull(one), hull(moved));
  EXPECT_NE(hull(one), hull(LoadDiagram(file())));
  for (const LoadedDiagram::Block& block : one.systems) {
    EXPECT_NE(one.diagram->FindSystem(block.name), two.diagram->FindSystem(block.name));
  }
}

TEST(BlueprintTest, RunsOfOneBlueprintDoNotMeet) {
  const Blueprint blueprint(kFolder / "first.yaml");
  const auto metrics = [](const LoadedDiagram& loaded) { return runs::Run(loaded, {}).metrics; };
  const LoadedDiagram slow = blueprint.Build({{"parameters.rate", "50"}});
  const auto alone = metrics(slow);
  const LoadedDiagram fast = blueprint.Build({{"parameters.rate", "200"}});
  const auto other = metrics(fast);
  EXPECT_NE(alone, other);
  EXPECT_EQ(metrics(slow), alone);
  EXPECT_EQ(metrics(LoadDiagram(kFolder / "first.yaml", {{"parameters.rate", "200"}})), other);
}

TEST(BlueprintTest, ThreadsBuildTheSame) {
  const fs::path file = kFolder / "static_test.yaml";
  const auto overrides = [](int n) -> Overrides {
    return {{"parameters.arm_meshes", n % 2 == 0 ? "true" : "false"},
            {"parameters.avoidance", n % 3 == 0 ? "safety_filter" : "report"},
            {"models.arm.base_pose.xyz.0", std::to_string(0.01 * n)}};
  };
  const Blueprint blueprint(file);
  std::vector<std::vector<std::string>> built(24);
  {
    std::vector<std::jthread> threads;
    for (std::size_t first = 0; first < 4; ++first) {
      threads.emplace_back([&, first] {
        for (std::size_t n = first; n < built.size(); n += 4) {
          built[n] = Everything(blueprint.Build(overrides(static_cast<int>(n))));
        }
      });
    }
  }
  for (std::size_t n = 0; n < built.size(); ++n) {
    EXPECT_EQ(built[n], Everything(LoadDiagram(file, overrides(static_cast<int>(n)))));
  }
}

TEST(BlueprintTest, BuildsPartsAndMovableDiagrams) {
  const Blueprint blueprint(kFolder / "first.yaml");
  const LoadedDiagram whole = blueprint.Build();
  const LoadedDiagram part = blueprint.Build({}, {.part = InsideOf(*whole.diagram)});
  EXPECT_LT(part.systems.size(), whole.systems.size());
  EXPECT_NO_THROW(part.diagram->GetInput<Vector>("plant.position"));
  EXPECT_THAT(part.record, IsEmpty());
  const LoadedDiagram movable = blueprint.Build({}, {.movable = true});
  const auto& inputs = movable.diagram->exported_inputs();
  ASSERT_EQ(inputs.size(), 1u);
  EXPECT_EQ(inputs.front().name, "obstacles.offsets");
  EXPECT_THAT(whole.diagram->exported_inputs(), IsEmpty());
}

}  // namespace blueprint_test
}  // namespace oca::loading
