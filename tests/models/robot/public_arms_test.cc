// SPDX-License-Identifier: BSD-3-Clause
// The arms of tests/models/robot/arms, which tools/robot_table.sh runs: wrists and elbows of all
// kinds, from published Denavit-Hartenberg parameters.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "oca/models/robot/collision_check.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot {
namespace public_arms_test {

namespace fs = std::filesystem;

std::map<std::string, RobotModel> LoadArms() {
  std::map<std::string, RobotModel> arms;
  for (const auto& entry : fs::directory_iterator(OCA_SOURCE_DIR "/tests/models/robot/arms")) {
    if (entry.path().extension() != ".urdf") continue;
    LoadOptions options;
    options.srdf = fs::path(entry.path()).replace_extension(".srdf");
    arms.emplace(entry.path().stem().string(), LoadUrdf(entry.path(), options));
  }
  return arms;
}

TEST(PublicArmsTest, AreAtLeastTwelveWithFiveToSevenJoints) {
  const auto arms = LoadArms();
  EXPECT_GE(arms.size(), 12u);
  int grippers = 0;
  for (const auto& [name, arm] : arms) {
    int joints = 0;
    bool fingers = false;
    for (const Joint& joint : arm.joints()) {
      const bool finger = joint.name.text().ends_with("finger_joint");
      fingers |= finger;
      if (joint.type != JointType::kFixed && !finger) ++joints;
    }
    grippers += fingers ? 1 : 0;
    EXPECT_GE(joints, 5) << name;
    EXPECT_LE(joints, 7) << name;
    EXPECT_EQ(arm.num_positions(), joints + (fingers ? 1 : 0)) << name << ": fingers move as one";
  }
  EXPECT_GE(grippers, 4);
}

// What is disabled there is what few samples find too, and nothing that they see meet now and then.
TEST(PublicArmsTest, HaveTheSrdfThatSamplingFinds) {
  for (const auto& [name, arm] : LoadArms()) {
    for (const LinkPairCheck& pair : CheckCollisions(arm, {.samples = 500, .seed = 99})) {
      const bool disabled = arm.collision_disabled(pair.link_a, pair.link_b);
      const std::string pair_name = name + ": " + arm.links()[pair.link_a].name.text() + " " +
                                    arm.links()[pair.link_b].name.text();
      // What meets nearly always may do so a little less often here.
      const bool rare = pair.collisions < 450;
      if (pair.kind == PairKind::kSometimes && rare) {
        EXPECT_FALSE(disabled) << pair_name;
      }
      if (pair.kind == PairKind::kDefault) {
        EXPECT_TRUE(disabled) << pair_name;
      }
    }
  }
}

// At zero the UR10e lies along -x by a2 + a3, its flange d4 + d6 beside and d1 - d5 above its base.
TEST(PublicArmsTest, TheUr10eLiesAsItsTableSays) {
  const RobotModel arm = LoadArms().at("ur10e");
  const auto poses = LinkPoses(arm, Eigen::VectorXd::Zero(6));
  const Eigen::Vector3d p = poses[arm.FindLink("flange")].translation();
  EXPECT_NEAR(p.x(), -0.6127 - 0.57155, 1e-9);
  EXPECT_NEAR(p.y(), -0.17415 - 0.11655, 1e-9);
  EXPECT_NEAR(p.z(), 0.1807 - 0.11985, 1e-9);
}

}  // namespace public_arms_test
}  // namespace oca::robot
