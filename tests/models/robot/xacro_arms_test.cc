// SPDX-License-Identifier: BSD-3-Clause
// Small arms that are described in the manner of four vendors' public xacro files.
#include <gmock/gmock.h>

#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot::test {
namespace xacro_arms_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

const std::filesystem::path kArms = OCA_SOURCE_DIR "/tests/models/robot/xacro_arms";
constexpr double kPi = std::numbers::pi;

RobotModel Load(const std::string& file, const XacroArguments& arguments,
                std::vector<std::string>* warnings = nullptr) {
  LoadOptions options;
  options.package_directories = {kArms};
  options.xacro_arguments = arguments;
  if (warnings != nullptr)
    options.warn = [=](const std::string& line) { warnings->push_back(line); };
  return LoadUrdf(kArms / file, options);
}

std::vector<std::string> Positions(const RobotModel& robot) {
  std::vector<std::string> names;
  for (const models::Name& name : robot.position_names()) names.push_back(name.text());
  return names;
}

TEST(XacroArmsTest, ReadsParametersFromYamlIntoTheScopeOfTheCaller) {
  const RobotModel robot = Load("cobot_description/urdf/cobot.urdf.xacro", {{"type", "c5"}});
  EXPECT_EQ(robot.name().text(), "cobot");
  EXPECT_THAT(Positions(robot), ElementsAre("shoulder_pan", "shoulder_lift", "elbow", "wrist_1",
                                            "wrist_2", "wrist_3"));
  EXPECT_DOUBLE_EQ(robot.upper_limits()[0], 2 * kPi);
  EXPECT_DOUBLE_EQ(robot.lower_limits()[4], -2 * kPi);
  EXPECT_DOUBLE_EQ(robot.velocity_limits()[5], kPi);
  const Link& upper_arm = robot.links()[robot.FindLink("upper_arm")];
  EXPECT_DOUBLE_EQ(upper_arm.inertia.mass, 8.0);
  EXPECT_DOUBLE_EQ(upper_arm.inertia.I_C(2, 2), 0.5 * 8.0 * 0.05 * 0.05);
  EXPECT_EQ(robot.links()[robot.FindLink("base_link")].visuals[0].mesh_file,
            (kArms / "cobot_description/meshes/base.stl").string());
}

TEST(XacroArmsTest, NamesMeshesByPathsIfAsked) {
  const RobotModel robot =
      Load("cobot_description/urdf/cobot.urdf.xacro",
           {{"type", "c5"}, {"absolute_meshes", "true"}, {"tf_prefix", "left_"}, {"name", "two"}});
  EXPECT_EQ(robot.name().text(), "two");
  EXPECT_EQ(robot.links()[robot.FindLink("left_base_link")].visuals[0].mesh_file,
            (kArms / "cobot_description/meshes/base.stl").string());
}

TEST(XacroArmsTest, SaysWhichFileATypeLacks) {
  EXPECT_THAT([&] { Load("cobot_description/urdf/cobot.urdf.xacro", {}); },
              ThrowsMessage<models::ModelError>(
                  testing::AllOf(HasSubstr("cobot_common.xacro:"), HasSubstr("(called at "),
                                 HasSubstr("config/c5x/limits.yaml"))));
}

TEST(XacroArmsTest, ReadsDictionariesByDotsAndMakesCapsules) {
  std::vector<std::string> warnings;
  const RobotModel robot = Load("seven_description/robots/s7/s7.urdf.xacro", {}, &warnings);
  EXPECT_EQ(robot.num_positions(), 7);
  EXPECT_EQ(robot.FindLink("s7_hand_white"), robot.num_links() - 1);
  EXPECT_DOUBLE_EQ(robot.upper_limits()[robot.FindPosition("s7_joint4")], -0.1);
  const Link& link5 = robot.links()[robot.FindLink("s7_link5")];
  ASSERT_EQ(link5.collisions.size(), 2u);
  EXPECT_DOUBLE_EQ(std::get<geometry::Capsule>(link5.collisions[0].shape).radius, 0.06);
  EXPECT_THAT(warnings, testing::Contains(HasSubstr("No inertia of: link6")));
}

TEST(XacroArmsTest, LeavesPrefixesHandsAndSolidsOutIfAsked) {
  const RobotModel robot = Load("seven_description/robots/s7/s7.urdf.xacro",
                                {{"no_prefix", "true"}, {"hand", "false"}, {"with_sc", "false"}});
  EXPECT_EQ(robot.joints()[1].name.text(), "joint1");
  EXPECT_TRUE(robot.links()[robot.FindLink("link5")].collisions.empty());
}

TEST(XacroArmsTest, ChoosesByNumberOfJointsAndSerialNumber) {
  const std::string file = "xseries_description/urdf/device.urdf.xacro";
  const RobotModel six = Load(file, {});
  EXPECT_EQ(six.name().text(), "xseries6");
  EXPECT_EQ(six.num_positions(), 6);
  EXPECT_DOUBLE_EQ(six.upper_limits()[0], 2 * kPi);
  EXPECT_DOUBLE_EQ(six.links()[six.FindLink("link1")].inertia.mass, 2.2);
  const RobotModel five =
      Load(file, {{"dof", "5"}, {"limited", "true"}, {"robot_sn", "XI130011"}, {"prefix", "a_"}});
  EXPECT_EQ(five.num_positions(), 5);
  EXPECT_DOUBLE_EQ(five.upper_limits()[0], kPi * 0.99);
  EXPECT_DOUBLE_EQ(five.links()[five.FindLink("a_link1")].inertia.mass, 3.3);
}

TEST(XacroArmsTest, IncludesByTheNamesOfArmAndGripper) {
  const std::string file = "gen_description/robots/gen.urdf.xacro";
  const RobotModel robot = Load(file, {{"vision", "true"}});
  EXPECT_THAT(Positions(robot), ElementsAre("joint_1", "joint_2", "joint_3", "joint_4", "joint_5",
                                            "joint_6", "finger_joint"));
  EXPECT_TRUE(robot.joints()[robot.FindJoint("right_finger_joint")].mimic.has_value());
  EXPECT_GE(robot.FindLink("camera_link"), 0);
  EXPECT_DOUBLE_EQ(robot.upper_limits()[1], 128.9 * kPi / 180);
  const RobotModel bare = Load(file, {{"gripper", ""}, {"name", "bare"}});
  EXPECT_EQ(bare.num_positions(), 6);
  EXPECT_GE(bare.FindLink("tool_frame"), 0);
}

}  // namespace xacro_arms_test
}  // namespace oca::robot::test
