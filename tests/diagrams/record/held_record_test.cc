// SPDX-License-Identifier: BSD-3-Clause
// A record of a robot some joints of which are held runs from itself alone.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/mcap_writer.h"
#include "oca/diagrams/record/record_files.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/record/attached.h"
#include "tests/models/robot/gripper_arm.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace held_record_test {

TEST(HeldRecordTest, TakesAlongGroupsStatesAndLimits) {
  const oca::test::TemporaryFolder folder;
  folder.Write("robots/arm.urdf", robot::test::kGripperArmUrdf);
  folder.Write("robots/arm.srdf", robot::test::kGripperArmSrdf);
  folder.Write("robots/limits.yaml", "joint_limits: {elbow: {max_velocity: 0.5}}\n");
  const auto file = folder.Write(
      "work/d.yaml",
      "models: {arm: {urdf: ../robots/arm.urdf, srdf: ../robots/arm.srdf, group: arm, held: {hand: "
      "open}, joint_limits: ../robots/limits.yaml}}\n"
      "systems: {k: {type: RobotKinematics, model: arm}, q: {type: SplineGenerator, key_points: "
      "[{time: 0, position: ready}]}}\n"
      "connections: [q.position -> k.position]\n");
  const auto attachments = FilesOf(loading::LoadDiagram(file), 1.0);
  const ExtractedRecord extracted(test::FileOf(attachments));
  const auto again = extracted.Load({});
  const auto arm = again.models.Get("arm");
  EXPECT_EQ(arm->num_positions(), 2);
  EXPECT_EQ(arm->velocity_limits(), Eigen::Vector2d(2.0, 0.5));
  EXPECT_EQ(arm->joints()[arm->FindJoint("right_slide")].X_PJ.translation().y(), -0.03);
  for (const auto& opened : again.opened) {
    EXPECT_TRUE(models::LiesBelow(opened, extracted.diagram().parent_path())) << opened;
  }
  EXPECT_EQ(FilesOf(again, 1.0)[0].data, attachments[0].data);
}

}  // namespace held_record_test
}  // namespace oca::record
