// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/mcap_writer.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/record/attached.h"
#include "tests/diagrams/record/record_runs.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace record_files_test {

namespace fs = std::filesystem;
using oca::test::TemporaryFolder;
using testing::HasSubstr;

class EachDiagram : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(RecordFilesTest, EachDiagram,
                         testing::Values("static_test.yaml", "dynamic_test.yaml", "dual_arm.yaml",
                                         "link_forces_test.yaml", "attractive_goal.yaml",
                                         "planar_arm.yaml"),
                         [](const auto& tested) {
                           const std::string name = tested.param;
                           return name.substr(0, name.find('.'));
                         });

TEST_P(EachDiagram, RunsFromItsAttachmentsAloneWithTheSameBits) {
  const auto loaded = test::Load(GetParam());
  const auto attachments = FilesOf(loaded, loaded.simulator.duration);
  const ExtractedRecord extracted(test::FileOf(attachments));
  const auto again = loading::LoadDiagram(extracted.diagram());
  EXPECT_EQ(FilesOf(again, again.simulator.duration)[0].data, attachments[0].data)
      << "a record of a replay is another one";
  const runs::RunOptions options{.duration = 1.0};
  EXPECT_EQ(runs::Run(again, options).metrics, runs::Run(loaded, options).metrics);
}

TEST(RecordFilesTest, KeepsParametersSoThatOneCanBeChanged) {
  const auto attachments = FilesOf(test::Load("static_test.yaml"), 14.5);
  const ExtractedRecord extracted(test::FileOf(attachments));
  const auto changed =
      loading::LoadDiagram(extracted.diagram(), {{"parameters.test_obstacle_height", "1.5"}});
  EXPECT_NE(runs::Run(changed, {.duration = 4.0}).metrics,
            runs::Run(test::Load("static_test.yaml"), {.duration = 4.0}).metrics);
}

TEST(RecordFilesTest, KeepsOverridesAndTheDurationOfTheRun) {
  const auto loaded = test::Load("static_test.yaml", {{"parameters.max_distance", "0.125"}});
  const ExtractedRecord extracted(test::FileOf(FilesOf(loaded, 0.75)));
  const auto again = loading::LoadDiagram(extracted.diagram());
  EXPECT_EQ(again.simulator.duration, 0.75);
  EXPECT_THAT(FilesOf(again, 0.75)[0].data, HasSubstr("max_distance: 0.125"));
}

TEST(RecordFilesTest, ChoosesAnotherIncludedFileFromTheRecordAlone) {
  const auto loaded = test::Load("static_test.yaml", {{"parameters.test_obstacle_height", "1.05"}});
  const ExtractedRecord first(test::FileOf(FilesOf(loaded, 2.0)));
  // A record of a replay can choose, too.
  const ExtractedRecord second(test::FileOf(FilesOf(first.Load({}), 2.0)));
  const auto chosen = second.Load({{"parameters.avoidance", "safety_filter"}});
  EXPECT_NE(chosen.diagram->FindSystem("filter"), nullptr);
  EXPECT_EQ(chosen.simulator.duration, 2.0);
  const auto expected = test::Load("static_test.yaml", {{"parameters.test_obstacle_height", "1.05"},
                                                        {"parameters.avoidance", "safety_filter"}});
  EXPECT_EQ(runs::Run(chosen, {.duration = 2.0}).metrics,
            runs::Run(expected, {.duration = 2.0}).metrics);
}

TEST(RecordFilesTest, TakesARobotThatTheRecordLacksFromThisMachine) {
  const ExtractedRecord extracted(test::FileOf(FilesOf(test::Load("static_test.yaml"), 1.0)));
  const auto meshed = extracted.Load({{"parameters.arm_meshes", "true"}});
  const auto expected = test::Load("static_test.yaml", {{"parameters.arm_meshes", "true"}});
  EXPECT_EQ(runs::Run(meshed, {.duration = 1.0}).metrics,
            runs::Run(expected, {.duration = 1.0}).metrics);
}

/// A robot beside the diagram, its mesh beside the robot, a table of motion: none in a package.
TEST(RecordFilesTest, CarriesFilesThatLieBesideTheDiagram) {
  const TemporaryFolder folder;
  folder.Write("robots/meshes/part.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder.Write("robots/one.urdf", R"(<robot name="one">
<link name="base"/><link name="tip"><collision><geometry><mesh filename="meshes/part.obj"/>
</geometry></collision></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>
</robot>)");
  folder.Write("motion.csv", "time,x,y,z\n0,3,0,0\n1,2,0,0\n");
  const auto file = folder.Write("work/one.yaml", R"(
simulator: {duration: 1}
models: {arm: {urdf: ../robots/one.urdf}}
systems:
  q: {type: Constant, value: [0.5]}
  kinematics: {type: RobotKinematics, model: arm}
  obstacles:
    type: ObstacleSource
    obstacles: [{id: ball, shape: {type: sphere, radius: 0.1}, motion: {type: csv, file: ../motion.csv}}]
  distance: {type: BulletDistance, model: arm, max_distance: 10}
connections:
  - q.value -> kinematics.position
  - kinematics.links -> distance.links
  - obstacles.obstacles -> distance.obstacles
expect: {}
)");
  const auto attachments = FilesOf(loading::LoadDiagram(file), 1.0);
  std::vector<std::string> names;
  for (const auto& attachment : attachments) names.push_back(attachment.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         "diagram.yaml", "files/up/motion.csv", "files/up/robots/one.urdf",
                         "files/up/robots/meshes/part.obj", "sources/one.yaml", "sources.yaml"));
  const ExtractedRecord extracted(test::FileOf(attachments));
  EXPECT_EQ(FilesOf(loading::LoadDiagram(extracted.diagram()), 1.0)[0].data, attachments[0].data);
  // Its sources find the files, too.
  EXPECT_EQ(extracted.Load({{"simulator.duration", "0.5"}}).simulator.duration, 0.5);
}

std::vector<std::string> NamesOf(const std::vector<Attachment>& attachments) {
  std::vector<std::string> names;
  for (const auto& attachment : attachments) names.push_back(attachment.name);
  return names;
}

/// Where a file lies by its name, what it names lies from there, whatever its folder links to.
TEST(RecordFilesTest, RunsAgainWithOverridesIfFoldersAreLinks) {
  const TemporaryFolder folder;
  const std::string more = "include: [\"more_${kind}.yaml\"]\nparameters: {kind: big}\n";
  folder.Write("shared/deep/with.yaml",
               more + "systems: {gain: {type: Gain, gain: \"${factor}\"}}\n");
  folder.Write("shared/deep/more_big.yaml", "parameters: {factor: 3}\n");
  folder.Write("shared/stage.yaml",
               "parameters: {own: 2}\n"
               "systems:\n"
               "  gain: {type: Gain, gain: \"${own}\"}\n"
               "  o: {type: ObstacleSource, obstacles: [{id: a, shape: {type: cloud, file: "
               "deep/points.csv, radius: 0.1}, pose: {xyz: [0, 0, 0]}}]}\n"
               "connections: [inputs.in -> gain.in, gain.out -> outputs.out]\n");
  folder.Write("shared/deep/points.csv", "1,2,3\n");
  folder.Write("real/work/one.yaml",
               "include: [linked/with.yaml]\n"
               "systems:\n"
               "  source: {type: Constant, value: [1], unit: rad}\n"
               "  stage: {type: Diagram, file: linked/../stage.yaml}\n"
               "connections: [source.value -> gain.in, gain.out -> stage.in]\n");
  fs::create_directory_symlink("../../shared/deep", folder.path() / "real/work/linked");
  fs::create_directory_symlink("real/work", folder.path() / "top");
  for (const char* const way : {"real/work/one.yaml", "top/one.yaml"}) {
    const ExtractedRecord first(
        test::FileOf(FilesOf(loading::LoadDiagram(folder.path() / way), 1.0)));
    const ExtractedRecord second(
        test::FileOf(FilesOf(first.Load({{"parameters.factor", "4"}}), 1.0)));
    const auto again = second.Load({{"stage.parameters.own", "5"}});
    EXPECT_EQ(
        again.diagram->GetOutput<Vector>("stage.gain.out").Eval(again.diagram->MakeContext())[0],
        20.0)
        << way;
  }
}

TEST(RecordFilesTest, LeavesWhatAParameterCouldHaveChosenAtHome) {
  const TemporaryFolder folder;
  folder.Write("part_one.yaml", "systems: {c: {type: Constant, value: 1}}\n");
  folder.Write("part_secret.yaml", "# a password\nsystems: {}\n");
  folder.Write("other.yaml", "systems: {}\n");
  // In the name of a part of OCA, yet none.
  folder.Write("avoidance_report.yaml", "# a password\n");
  const auto file = folder.Write("main.yaml", R"(
include: ["part_${part}.yaml"]
parameters: {part: one}
)");
  EXPECT_THAT(NamesOf(FilesOf(loading::LoadDiagram(file), 1.0)),
              testing::UnorderedElementsAre("diagram.yaml", "sources/main.yaml",
                                            "sources/part_one.yaml", "sources.yaml"));
}

TEST(RecordFilesTest, CarriesTheOtherPartsOfOcaWhereverTheyLie) {
  const TemporaryFolder folder;
  const fs::path parts = fs::path(OCA_SOURCE_DIR) / "diagrams" / "parts";
  fs::copy(parts, folder.path() / "parts");
  fs::copy(parts.parent_path() / "static_test.yaml", folder.path() / "mine.yaml");
  folder.Write("parts/avoidance_mine.yaml", "# a password\n");
  folder.Write("parts/avoidance_vortex.yaml", "# changed\n");
  const auto names = NamesOf(FilesOf(loading::LoadDiagram(folder.path() / "mine.yaml"), 1.0));
  EXPECT_THAT(names, testing::Contains("sources/parts/avoidance_safety_filter.yaml"));
  EXPECT_THAT(names, testing::Not(testing::Contains("sources/parts/avoidance_mine.yaml")));
  EXPECT_THAT(names, testing::Not(testing::Contains("sources/parts/avoidance_vortex.yaml")));
}

/// A robot whose file names meshes that no robot has.
TEST(RecordFilesTest, CarriesTheMeshesThatTheRobotHas) {
  const TemporaryFolder folder;
  folder.Write("a&b.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder.Write("one.urdf", R"(<robot name="one"><link name="base"/>
<!-- <link name="old"><visual><geometry><mesh filename="gone.stl"/></geometry></visual></link> -->
<link name="tip"><collision><geometry><mesh filename="a&amp;b.obj"/></geometry></collision></link>
<gazebo><visual><geometry><mesh filename="model://x.dae"/></geometry></visual></gazebo>
<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>
</robot>)");
  const auto file = folder.Write("main.yaml", R"(
models: {arm: {urdf: one.urdf}}
systems: {q: {type: Constant, value: [0.5]}, k: {type: RobotKinematics}}
connections: [q.value -> k.position]
)");
  const auto attachments = FilesOf(loading::LoadDiagram(file), 1.0);
  EXPECT_THAT(NamesOf(attachments),
              testing::UnorderedElementsAre("diagram.yaml", "files/one.urdf", "files/a&b.obj",
                                            "sources/main.yaml", "sources.yaml"));
  const ExtractedRecord extracted(test::FileOf(attachments));
  EXPECT_EQ(extracted.Load({}).models.all().size(), 1u);
}

TEST(RecordFilesTest, RefusesToReadWhatDidNotComeWithTheRecord) {
  const TemporaryFolder folder;
  const std::string private_table = folder.Write("private.csv", "1,2,3\n").string();
  const auto load = [](const std::string& head, const std::string& name) {
    const std::string diagram =
        head +
        "systems: {o: {type: ObstacleSource, obstacles: [{id: a, pose: {xyz: [0, 0, 0]}, "
        "shape: {type: cloud, file: " +
        name + ", radius: 0.1}}]}}\n";
    const ExtractedRecord extracted(
        test::FileOf({{0, "diagram.yaml", "", diagram}, {0, "files/a.csv", "", "1,2,3\n"}}));
    return extracted.Load({}).opened.size();
  };
  EXPECT_EQ(load("", "files/a.csv"), 2u);
  for (const auto& place :
       {std::pair<std::string, std::string>("", private_table),
        {"packages: {p: " + folder.path().string() + "}\n", "package://p/private.csv"},
        {"", "files/../../../" + private_table}}) {
    EXPECT_THAT([&] { load(place.first, place.second); },
                testing::ThrowsMessage<ConfigError>(HasSubstr("outside of the record")))
        << place.first << place.second;
  }
}

TEST(RecordFilesTest, RefusesAttachmentsThatWouldLeaveTheFolder) {
  const TemporaryFolder folder;
  for (const char* const name : {"../evil", "/evil", "a/../../evil"}) {
    const McapFile file =
        test::FileOf({{0, "diagram.yaml", "", "systems: {}"}, {0, name, "", "x"}});
    EXPECT_THROW(ExtractFiles(file, folder.path() / "inside"), ConfigError) << name;
  }
}

TEST(RecordFilesTest, RefusesTwoAttachmentsOfOneName) {
  for (const char* name : {"diagram.yaml", "a/../diagram.yaml"}) {
    try {
      ExtractedRecord(test::FileOf({{0, "diagram.yaml", "", "a"}, {0, name, "", "b"}}));
      ADD_FAILURE() << name;
    } catch (const ConfigError& error) {
      EXPECT_STREQ(error.what(),
                   "attachments: attachment; got 'diagram.yaml' twice; expected each name once");
    }
  }
}

TEST(RecordFilesTest, SaysWhyARecordHasNoDiagram) {
  std::ostringstream stream;
  McapWriter writer(stream, Compression::kNone);
  writer.AddAttachment({0, "diagram.yaml", "", "systems: {}"});
  writer.Close();
  std::string bytes = stream.str();
  ++bytes[bytes.find("systems")];
  try {
    ExtractedRecord(McapFile::Parse(bytes, "changed"));
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex(
                                  "changed: breaks off at byte [0-9]+: attachment: wrong CRC; got "
                                  "no attachment diagram.yaml before it; expected one"));
  }
}

TEST(RecordFilesTest, RefusesARecordWithoutADiagram) {
  EXPECT_THROW(ExtractedRecord{test::FileOf({})}, ConfigError);
}

}  // namespace record_files_test
}  // namespace oca::record
