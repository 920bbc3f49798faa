// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/hold_joints.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/gripper_arm.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace hold_joints_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

RobotModel Load(const HeldJoints& held, LoadOptions options = {}) {
  const oca::test::TemporaryFolder folder;
  options.srdf = folder.Write("arm.srdf", kGripperArmSrdf);
  options.held = held;
  return ParseUrdf(kGripperArmUrdf, "arm.urdf", options);
}

std::string RefusalOf(const HeldJoints& held) {
  try {
    Load(held);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<std::string> Positions(const RobotModel& robot) {
  std::vector<std::string> names;
  for (const models::Name& name : robot.position_names()) names.push_back(name.text());
  return names;
}

TEST(HoldJointsTest, AHeldJointIsNoPositionAndStandsWhereItIsHeld) {
  const RobotModel free = Load({});
  const RobotModel held = Load({.positions = {{"left_slide", 0.03}, {"shoulder", -0.7}}});
  ASSERT_THAT(Positions(free), ElementsAre("shoulder", "elbow", "left_slide", "roll"));
  ASSERT_THAT(Positions(held), ElementsAre("elbow", "roll"));
  const auto expected = LinkPoses(free, Eigen::Vector4d(-0.7, 1.1, 0.03, 0.4));
  const auto poses = LinkPoses(held, Eigen::Vector2d(1.1, 0.4));
  for (int link = 0; link < free.num_links(); ++link) {
    EXPECT_TRUE(poses[link].isApprox(expected[link], 1e-15)) << free.links()[link].name.text();
  }
  // The right finger follows the left one: 0.5 * 0.03 + 0.01.
  const Eigen::Isometry3d X_FR =
      poses[held.FindLink("fore")].inverse() * poses[held.FindLink("right")];
  EXPECT_TRUE(X_FR.translation().isApprox(Eigen::Vector3d(0.4, -0.025, 0.0), 1e-14));
  EXPECT_EQ(held.position_unit(), "rad");
  EXPECT_EQ(held.body(held.FindLink("upper")), -1);
}

TEST(HoldJointsTest, AGroupLeavesAllOthersHeld) {
  const RobotModel arm = Load({.group = "arm"});
  EXPECT_THAT(Positions(arm), ElementsAre("shoulder", "elbow"));
  const auto at = [](const RobotModel& robot, const char* link) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(robot.num_positions(), 0.5);
    const auto X = LinkPoses(robot, q);
    return Eigen::Vector3d(
        (X[robot.FindLink("fore")].inverse() * X[robot.FindLink(link)]).translation());
  };
  EXPECT_TRUE(at(arm, "left").isApprox(Eigen::Vector3d(0.4, 0.0, 0.0), 1e-14));
  EXPECT_TRUE(at(arm, "right").isApprox(Eigen::Vector3d(0.4, -0.01, 0.0), 1e-14));
  const RobotModel open = Load({.group = "arm", .states = {{"hand", "open"}}});
  const Eigen::Vector3d left(0.4 - 0.04 * std::sin(0.5), 0.04 * std::cos(0.5), 0.0);
  EXPECT_TRUE(at(open, "left").isApprox(left, 1e-14));
  EXPECT_TRUE(at(open, "right").isApprox(Eigen::Vector3d(0.4, -0.03, 0.0), 1e-14));
  // A number wins over a state.
  const RobotModel ajar =
      Load({.group = "arm", .positions = {{"left_slide", 0.02}}, .states = {{"hand", "open"}}});
  EXPECT_TRUE(at(ajar, "right").isApprox(Eigen::Vector3d(0.4, -0.02, 0.0), 1e-14));
}

TEST(HoldJointsTest, WhatIsHeldWithoutAPlaceIsAtZeroOrTheLimitNearestToIt) {
  const RobotModel hand = Load({.group = "hand"});
  EXPECT_THAT(Positions(hand), ElementsAre("left_slide"));
  const auto X = LinkPoses(hand, Eigen::VectorXd::Zero(1));
  const Eigen::Vector3d wrist = X[hand.FindLink("left")].translation();
  // The shoulder at 0, the elbow at its lower limit 0.1.
  EXPECT_TRUE(
      wrist.isApprox(Eigen::Vector3d(0.5 + 0.4 * std::cos(0.1), 0.4 * std::sin(0.1), 0.3), 1e-14));
}

TEST(HoldJointsTest, GroupsAreChainsJointsLinksAndGroups) {
  EXPECT_THAT(Positions(Load({.group = "finger"})), ElementsAre("left_slide"));
  EXPECT_THAT(Positions(Load({.group = "whole"})), ElementsAre("shoulder", "elbow", "left_slide"));
  EXPECT_THAT(Positions(Load({.group = "whole", .positions = {{"elbow", 0.2}}})),
              ElementsAre("shoulder", "left_slide"));
  const oca::test::TemporaryFolder folder;
  const RobotModel robot = Load({});
  const SrdfGroup across{"across", {}, {}, {}, {{"right", "upper"}}};
  EXPECT_THAT(JointsOfGroup(robot, {across}, "across"),
              ElementsAre(robot.FindJoint("elbow"), robot.FindJoint("right_slide")));
}

TEST(HoldJointsTest, PassiveJointsAreHeld) {
  EXPECT_THAT(Positions(Load({.group = "driven"})), ElementsAre("shoulder"));
}

TEST(HoldJointsTest, LimitsAreOfTheJointsThatMove) {
  LoadOptions options;
  options.acceleration_limits = Eigen::Vector2d(3.0, 4.0);
  const RobotModel arm = Load({.group = "arm"}, options);
  EXPECT_EQ(arm.acceleration_limits(), Eigen::Vector2d(3.0, 4.0));
}

TEST(HoldJointsTest, PairsThatWereCheckedStayCheckedUnlessRigid) {
  const RobotModel free = Load({});
  const RobotModel held = Load({.positions = {{"elbow", 0.5}}});
  const auto link = [&](const char* name) { return free.FindLink(name); };
  EXPECT_FALSE(free.adjacent(link("upper"), link("left")));
  EXPECT_FALSE(free.adjacent(link("base"), link("fore")));
  EXPECT_FALSE(held.adjacent(link("upper"), link("left")));
  EXPECT_FALSE(held.adjacent(link("base"), link("fore")));
  EXPECT_TRUE(held.adjacent(link("upper"), link("fore")));
  EXPECT_TRUE(held.adjacent(link("fore"), link("left")));
  EXPECT_TRUE(held.adjacent(link("base"), link("upper")));
  const RobotModel still = Load({.positions = {{"left_slide", 0.0}}});
  EXPECT_TRUE(still.adjacent(link("left"), link("right")));  // rigid, so nothing is to be done
}

TEST(HoldJointsTest, WhatCannotBeHeldIsRefused) {
  EXPECT_THAT(RefusalOf({.positions = {{"elbo", 0.0}}}),
              AllOf(HasSubstr("held.elbo: got no joint of the robot"),
                    HasSubstr("shoulder, elbow, left_slide, roll; nearest is 'elbow'")));
  EXPECT_THAT(RefusalOf({.positions = {{"right_slide", 0.02}}}),
              HasSubstr("held.right_slide: got a mimic; expected the joint that it follows, "
                        "'left_slide'"));
  EXPECT_THAT(RefusalOf({.positions = {{"left_slide", 0.041}}}),
              HasSubstr("held.left_slide: got 0.041 m; expected 0 to 0.04, its limits"));
  EXPECT_EQ(RefusalOf({.positions = {{"left_slide", 0.04}}}), "accepted");
  EXPECT_THAT(RefusalOf({.positions = {{"elbow", 0.099}}}), HasSubstr("got 0.099 rad"));
  EXPECT_THAT(RefusalOf({.states = {{"hand", "torn"}}}),
              HasSubstr("held.hand: got 0.05 m of joint 'left_slide' in 'torn'"));
  EXPECT_THAT(RefusalOf({.states = {{"hand", "opne"}}}),
              HasSubstr("held.hand: unknown state; got 'opne'; expected one of open, torn, home; "
                        "nearest is 'open'"));
  EXPECT_THAT(RefusalOf({.states = {{"hnad", "open"}}}),
              HasSubstr("held.hnad: unknown group; got 'hnad'"));
  EXPECT_THAT(RefusalOf({.states = {{"elbow", "x"}}}),
              HasSubstr("held.elbow: got 'x'; expected a finite number, rad or m"));
}

TEST(HoldJointsTest, GroupsThatAreNoneAreRefused) {
  EXPECT_THAT(RefusalOf({.group = "amr"}),
              AllOf(HasSubstr("group: unknown group; got 'amr'"), HasSubstr("nearest is 'arm'")));
  EXPECT_THAT(RefusalOf({.group = "nothing"}),
              HasSubstr("group: got 'nothing', of which no joint moves"));
  EXPECT_THAT(RefusalOf({.group = "hand", .positions = {{"left_slide", 0.0}}}),
              HasSubstr("group: got 'hand', of which no joint moves"));
  EXPECT_THAT(
      RefusalOf({.group = "other_finger"}),
      HasSubstr("group: 'other_finger'; got joint 'right_slide' without 'left_slide', which "
                "it mimics"));
  EXPECT_THAT(RefusalOf({.group = "ring"}), HasSubstr("in itself"));
  LoadOptions without_srdf;
  without_srdf.held.group = "arm";
  EXPECT_THAT([&] { ParseUrdf(kGripperArmUrdf, "arm.urdf", without_srdf); },
              testing::ThrowsMessage<models::ModelError>(HasSubstr("none, there is none")));
}

TEST(HoldJointsTest, MessagesSayThatAJointIsHeld) {
  const RobotModel arm = Load({.group = "arm"});
  EXPECT_THAT([&] { arm.FindPosition("left_slide"); },
              testing::ThrowsMessage<models::ModelError>(HasSubstr("which is held")));
}

}  // namespace hold_joints_test
}  // namespace oca::robot::test
