// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/joint_limits_file.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/gripper_arm.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace joint_limits_file_test {

using testing::AllOf;
using testing::HasSubstr;

RobotModel Load(const std::string& limits, LoadOptions options = {}) {
  const oca::test::TemporaryFolder folder;
  options.joint_limits = folder.Write("joint_limits.yaml", limits);
  return ParseUrdf(kGripperArmUrdf, "arm.urdf", options);
}

std::string RefusalOf(const std::string& limits) {
  try {
    Load(limits);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

/// As MoveIt's assistant writes it, with a line of one joint changed.
const char* const kLimits = R"(# how MoveIt's assistant writes it
default_velocity_scaling_factor: 0.1
default_acceleration_scaling_factor: 0.1
joint_limits:
  shoulder:
    has_velocity_limits: true
    max_velocity: 1.5
    has_acceleration_limits: true
    max_acceleration: 3.75
    has_jerk_limits: true
    max_jerk: 500
  elbow:
    has_velocity_limits: true
    max_velocity: 9
    has_acceleration_limits: false
    max_acceleration: 0
    has_deceleration_limits: true
    max_deceleration: 2
    has_position_limits: true
    min_position: -1
    max_position: 2
  roll: {max_velocity: 7, has_effort_limits: true, max_effort: 3}
)";

TEST(JointLimitsFileTest, FillsAndNarrowsAndNeverWidens) {
  const RobotModel robot = Load(kLimits);
  EXPECT_EQ(robot.velocity_limits(), Eigen::Vector4d(1.5, 2.0, 0.2, 7.0));
  EXPECT_EQ(robot.acceleration_limits(), Eigen::Vector4d(3.75, 2.0, kUnlimited, kUnlimited));
  EXPECT_EQ(robot.jerk_limits(), Eigen::Vector4d(500.0, kUnlimited, kUnlimited, kUnlimited));
  EXPECT_EQ(robot.effort_limits(), Eigen::Vector4d(50.0, 50.0, 20.0, 3.0));
  EXPECT_EQ(robot.lower_limits()[1], 0.1);
  EXPECT_EQ(robot.upper_limits()[1], 2.0);
}

TEST(JointLimitsFileTest, NarrowsWhatTheDiagramSaysForAllJoints) {
  LoadOptions options;
  options.acceleration_limits = Eigen::VectorXd::Constant(1, 3.0);
  EXPECT_EQ(Load(kLimits, options).acceleration_limits(), Eigen::Vector4d(3.0, 2.0, 3.0, 3.0));
}

TEST(JointLimitsFileTest, AJointIsHeldWithinItsRange) {
  LoadOptions options;
  options.held.positions = {{"elbow", 2.1}};
  EXPECT_THAT([&] { Load(kLimits, options); },
              testing::ThrowsMessage<models::ModelError>(
                  HasSubstr("held.elbow: got 2.1 rad; expected 0.1 to 2, its limits")));
  options.held.positions = {{"shoulder", 0.0}};
  EXPECT_EQ(Load(kLimits, options).velocity_limits(), Eigen::Vector3d(2.0, 0.2, 7.0));
}

TEST(JointLimitsFileTest, MayStandBelowOtherKeys) {
  EXPECT_EQ(Load("/**:\n  ros__parameters:\n    robot_description_planning:\n      joint_limits:\n"
                 "        elbow: {has_velocity_limits: true, max_velocity: 0.5}\n")
                .velocity_limits()[1],
            0.5);
}

TEST(JointLimitsFileTest, WhatIsWrongIsRefusedWithItsLine) {
  const auto of_elbow = [](const std::string& line) {
    return RefusalOf("joint_limits:\n  elbow:\n    " + line + "\n");
  };
  EXPECT_THAT(of_elbow("max_velocity: -1"),
              AllOf(HasSubstr("joint_limits.yaml:3: joint 'elbow': max_velocity; got '-1'"),
                    HasSubstr("a number of 1e-06 or more")));
  EXPECT_THAT(of_elbow("max_acceleration: 1.0e-300"), HasSubstr("a number of 1e-06 or more"));
  EXPECT_EQ(of_elbow("has_position_limits: true\n    max_position: 2"), "accepted");
  EXPECT_THAT(of_elbow("has_position_limits: true"),
              AllOf(HasSubstr("min_position; got none"), HasSubstr("max_position; got none")));
  EXPECT_THAT(of_elbow("max_velocity: .inf"), HasSubstr("got '.inf'"));
  EXPECT_THAT(of_elbow("max_velocity: nan"), HasSubstr("got 'nan'"));
  EXPECT_THAT(of_elbow("has_velocity_limits: true"),
              HasSubstr("joint_limits.yaml:3: joint 'elbow': max_velocity; got none"));
  EXPECT_THAT(of_elbow("has_velocity_limits: maybe"),
              HasSubstr("got 'maybe'; expected true or false"));
  EXPECT_THAT(of_elbow("has_velocity_limit: true"),
              HasSubstr("unknown key; got has_velocity_limit; expected has_velocity_limits"));
  EXPECT_EQ(of_elbow("comment_of_mine: 3"), "accepted");
  EXPECT_THAT(of_elbow("min_position: 2.3"),
              AllOf(HasSubstr("joint_limits.yaml:2: joint 'elbow': position limits; got 2.3"),
                    HasSubstr("a part of 0.1 to 2.2")));
  EXPECT_THAT(of_elbow("max_velocity: 1\n    max_velocity: 2"),
              HasSubstr("max_velocity; got it twice"));
  EXPECT_THAT(RefusalOf("joint_limits:\n  elbwo: {max_velocity: 1}\n"),
              AllOf(HasSubstr("joint_limits.yaml:2: unknown joint; got 'elbwo'"),
                    HasSubstr("nearest is 'elbow'")));
  EXPECT_THAT(
      of_elbow("max_velocity: -1\n    max_jerk: 0\n    has_effort_limit: true"),
      AllOf(HasSubstr(":3: joint 'elbow': max_velocity"), HasSubstr(":4: joint 'elbow': max_jerk"),
            HasSubstr(":5: joint 'elbow': unknown")));
  EXPECT_THAT(RefusalOf("limits: {elbow: {max_velocity: 1}}\n"),
              HasSubstr("joint_limits; got none"));
  EXPECT_THAT(RefusalOf("joint_limits: [1]\n"), HasSubstr("joint_limits; got a list"));
  EXPECT_THAT(RefusalOf("joint_limits: {elbow: 3}\n"), HasSubstr("joint 'elbow'; got '3'"));
  EXPECT_THAT(RefusalOf("joint_limits: {elbow: [3]}\n"), HasSubstr("joint 'elbow'; got a list"));
  EXPECT_THAT(RefusalOf("joint_limits: {elbow: {\n"), HasSubstr("joint_limits.yaml:"));
  EXPECT_THAT(RefusalOf("joint_limits: {? [k] : {c: 1}}\n"), HasSubstr("a key that is a list"));
  EXPECT_THAT(RefusalOf("a: &x {b: 1}\njoint_limits: {elbow: *x}\n"), HasSubstr("an alias"));
  EXPECT_THAT([] { JointLimitsFile("/nowhere.yaml"); },
              testing::ThrowsMessage<models::ModelError>(HasSubstr("/nowhere.yaml")));
}

}  // namespace joint_limits_file_test
}  // namespace oca::robot::test
