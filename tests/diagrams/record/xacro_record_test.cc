// SPDX-License-Identifier: BSD-3-Clause
// A record of a robot in xacro holds what the xacro is made of, and runs from that alone.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/mcap_writer.h"
#include "oca/diagrams/record/record_files.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/record/attached.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace xacro_record_test {

namespace fs = std::filesystem;
using oca::test::TemporaryFolder;
using testing::IsSupersetOf;

std::vector<std::string> NamesOf(const std::vector<Attachment>& attachments) {
  std::vector<std::string> names;
  for (const auto& attachment : attachments) names.push_back(attachment.name);
  return names;
}

void ExpectAllBelow(const std::vector<fs::path>& files, const fs::path& folder) {
  for (const fs::path& file : files) EXPECT_TRUE(models::LiesBelow(file, folder)) << file;
}

TEST(XacroRecordTest, TakesAlongWhatPackagesGaveTheXacro) {
  const TemporaryFolder folder;
  const auto file = folder.Write(
      "d.yaml", "packages: {cobot_description: " OCA_SOURCE_DIR
                "/tests/models/robot/xacro_arms/cobot_description}\n"
                "models: {arm: {xacro: package://cobot_description/urdf/cobot.urdf.xacro, "
                "arguments: {type: c5, absolute_meshes: true}}}\n"
                "systems: {k: {type: RobotKinematics, model: arm}, q: {type: Constant, value: [0, "
                "0, 0, 0, 0, 0]}}\nconnections: [q.value -> k.position]\n");
  const auto attachments = FilesOf(loading::LoadDiagram(file), 1.0);
  EXPECT_THAT(NamesOf(attachments),
              IsSupersetOf({"packages/cobot_description/urdf/cobot.urdf.xacro",
                            "packages/cobot_description/urdf/cobot_macro.xacro",
                            "packages/cobot_description/urdf/inc/cobot_common.xacro",
                            "packages/cobot_description/config/c5/limits.yaml",
                            "packages/cobot_description/config/c5/shape.yaml",
                            "packages/cobot_description/meshes/base.stl"}));
  const ExtractedRecord extracted(test::FileOf(attachments));
  const auto again = extracted.Load({});
  EXPECT_EQ(again.models.Get("arm")->num_positions(), 6);
  ExpectAllBelow(again.opened, extracted.diagram().parent_path());
  EXPECT_EQ(FilesOf(again, 1.0)[0].data, attachments[0].data);
}

TEST(XacroRecordTest, TakesAlongWhatLiesAroundTheXacro) {
  const TemporaryFolder folder;
  folder.Write("lib/joint.xacro",
               "<robot xmlns:xacro='x'><xacro:macro name='joint' params='i'>\n"
               "<link name='l${i}'/><joint name='j${i}' type='prismatic'>\n"
               "<parent link='l${i - 1}'/><child link='l${i}'/><axis xyz='1 0 0'/>\n"
               "<limit lower='0' upper='${config.upper}' effort='1' velocity='1'/></joint>\n"
               "<xacro:if value='${i &lt; $(arg n)}'><xacro:joint i='${i + 1}'/></xacro:if>\n"
               "</xacro:macro></robot>\n");
  folder.Write("robots/config/limits.yaml", "upper: 2.5\n");
  folder.Write("robots/config/unused.yaml", "secret: 1\n");
  folder.Write("robots/arm.urdf.xacro",
               "<robot name='arm' xmlns:xacro='x'><xacro:arg name='n' default='1'/>\n"
               "<xacro:property name='config' value=\"${load_yaml('config/limits.yaml')}\"/>\n"
               "<xacro:include filename='../lib/joint.xacro'/>\n"
               "<link name='l0'/><xacro:joint i='1'/></robot>\n");
  const auto file = folder.Write(
      "work/d.yaml",
      "models: {arm: {xacro: ../robots/arm.urdf.xacro, arguments: {n: 2}}}\n"
      "systems: {k: {type: RobotKinematics, model: arm}, q: {type: Constant, value: 0.5}}\n"
      "connections: [q.value -> k.position]\n");
  const auto attachments = FilesOf(loading::LoadDiagram(file), 1.0);
  EXPECT_THAT(NamesOf(attachments),
              testing::UnorderedElementsAre(
                  "diagram.yaml", "files/up/robots/arm.urdf.xacro", "files/up/lib/joint.xacro",
                  "files/up/robots/config/limits.yaml", "sources/d.yaml", "sources.yaml"));
  const ExtractedRecord extracted(test::FileOf(attachments));
  const auto again = extracted.Load({});
  EXPECT_EQ(again.models.Get("arm")->num_positions(), 2);
  EXPECT_DOUBLE_EQ(again.models.Get("arm")->upper_limits()[1], 2.5);
  EXPECT_EQ(FilesOf(again, 1.0)[0].data, attachments[0].data);
  const auto other = extracted.Load({{"models.arm.arguments.n", "3"}});
  EXPECT_EQ(other.models.Get("arm")->num_positions(), 3);
}

}  // namespace xacro_record_test
}  // namespace oca::record
