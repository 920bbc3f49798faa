// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/posture.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/gripper_arm.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace posture_test {

using testing::HasSubstr;

RobotModel Load(const HeldJoints& held = {}) {
  const oca::test::TemporaryFolder folder;
  LoadOptions options;
  options.srdf = folder.Write("arm.srdf", kGripperArmSrdf);
  options.held = held;
  return ParseUrdf(kGripperArmUrdf, "arm.urdf", options);
}

template <class Call>
std::string RefusalOf(const Call& call) {
  try {
    call();
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

const Eigen::Vector4d kBefore(1.0, 1.5, 0.02, 0.3);

TEST(PostureTest, ZeroIsMovedIntoTheLimits) {
  EXPECT_EQ(ZeroPosture(Load()), Eigen::Vector4d(0.0, 0.1, 0.0, 0.0));
}

TEST(PostureTest, AStateMovesItsJointsAlone) {
  const RobotModel robot = Load();
  EXPECT_EQ(WithState(robot, "ready", kBefore), Eigen::Vector4d(0.3, 1.2, 0.02, 0.3));
  EXPECT_EQ(WithState(robot, "bent", kBefore), Eigen::Vector4d(1.0, 2.0, 0.02, 0.3));
  EXPECT_EQ(WithState(robot, "open", kBefore), Eigen::Vector4d(1.0, 1.5, 0.04, 0.3));
  EXPECT_EQ(WithState(robot, "hand/home", kBefore), Eigen::Vector4d(1.0, 1.5, 0.01, 0.3));
}

TEST(PostureTest, NamedJointsMoveAlone) {
  EXPECT_EQ(WithPositions(Load(), {{"elbow", 0.7}, {"roll", -2.0}}, kBefore),
            Eigen::Vector4d(1.0, 0.7, 0.02, -2.0));
}

TEST(PostureTest, NamesOfNothingAreRefusedWithThoseThereAre) {
  const RobotModel robot = Load();
  EXPECT_THAT(RefusalOf([&] { WithState(robot, "redy", kBefore); }),
              HasSubstr("got 'redy'; expected a state of 'gripper_arm': open, torn, ready, bent, "
                        "home, home; nearest is 'ready'"));
  EXPECT_THAT(RefusalOf([&] { WithState(robot, "home", kBefore); }),
              HasSubstr("got 'home', of which there are several; expected one of arm/home, "
                        "hand/home"));
  EXPECT_THAT(RefusalOf([&] {
                WithPositions(robot, {{"elbwo", 1.0}}, kBefore);
              }),
              HasSubstr("got 'elbwo'; expected joints of 'gripper_arm': shoulder, elbow, "
                        "left_slide, roll; nearest is 'elbow'"));
  EXPECT_THAT(RefusalOf([&] {
                WithPositions(robot, {{"right_slide", 0.01}}, kBefore);
              }),
              HasSubstr("got 'right_slide', which is a mimic"));
}

TEST(PostureTest, OfHeldJointsNothingIsSaid) {
  const RobotModel arm = Load({.group = "arm"});
  EXPECT_EQ(WithState(arm, "ready", Eigen::Vector2d::Zero()), Eigen::Vector2d(0.3, 1.2));
  EXPECT_THAT(RefusalOf([&] { WithState(arm, "open", Eigen::Vector2d::Zero()); }),
              HasSubstr("got 'open', a state of no joint that moves"));
  EXPECT_THAT(RefusalOf([&] {
                WithPositions(arm, {{"left_slide", 0.01}}, Eigen::Vector2d::Zero());
              }),
              HasSubstr("got 'left_slide', which is held; expected joints of 'gripper_arm': "
                        "shoulder, elbow"));
}

}  // namespace posture_test
}  // namespace oca::robot::test
