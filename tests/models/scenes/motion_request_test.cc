// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/motion_request.h"

#include <gmock/gmock.h>

#include <string>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::scenes {
namespace motion_request_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

MotionRequest Read(const std::string& text) {
  const test::TemporaryFolder folder;
  return ReadMotionRequest(folder.Write("request.yaml", text));
}

std::string RefusalOf(const std::string& text) {
  try {
    Read(text);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MotionRequestTest, OfJointsHasStartAndGoal) {
  const MotionRequest request = Read(R"(start_state:
  joint_state: {name: [j1, j2], position: [0, -0.785]}
goal_constraints:
  - joint_constraints:
      - {joint_name: j1, position: 1.5, tolerance_above: 0.01, tolerance_below: 0.01, weight: 1}
      - joint_name: j2
        position: -2
workspace_parameters: {header: {frame_id: ""}, max_corner: [1, 1, 1], min_corner: [-1, -1, -1]}
planner_id: RRTConnect
group_name: arm
max_velocity_scaling_factor: 0.5
)");
  EXPECT_EQ(request.group, "arm");
  EXPECT_EQ(*request.start.Find("j2"), -0.785);
  EXPECT_EQ(*request.goal.Find("j1"), 1.5);
  EXPECT_EQ(request.goal.positions.size(), 2U);
  EXPECT_FALSE(request.pose.has_value());
  EXPECT_THAT(request.notes,
              ElementsAre(HasSubstr("request.yaml:8: workspace_parameters: not looked at"),
                          HasSubstr("max_velocity_scaling_factor: 0.5 not taken over")));
}

const char* const kPose = R"(goal_constraints:
  - position_constraints:
      - header: {frame_id: base}
        link_name: hand
        target_point_offset: {x: 0, y: 0, z: 0.1}
        constraint_region:
          primitives: [{type: 2, dimensions: [0.001]}]
          primitive_poses: [{position: {x: 0.4, y: 0.1, z: 0.5}, orientation: {x: 0, y: 0, z: 0, w: 1}}]
    orientation_constraints:
      - {header: {frame_id: base}, link_name: hand, orientation: {x: 1, y: 0, z: 0, w: 0}}
)";

TEST(MotionRequestTest, OfAPoseHasLinkPointAndRotation) {
  const MotionRequest request = Read(kPose);
  ASSERT_TRUE(request.pose.has_value());
  EXPECT_EQ(request.pose->link.text, "hand");
  EXPECT_EQ(request.pose->frame.text, "base");
  EXPECT_EQ(request.pose->position, Eigen::Vector3d(0.4, 0.1, 0.5));
  EXPECT_EQ(request.pose->offset.z(), 0.1);
  EXPECT_EQ(request.pose->rotation->x(), 1.0);
}

TEST(MotionRequestTest, WhatIsNoSingleGoalIsRefusedWithItsLine) {
  const std::string goal = "{joint_constraints: [{joint_name: a, position: 0}]}";
  EXPECT_EQ(RefusalOf("goal_constraints: [" + goal + "]\n"), "accepted");
  EXPECT_THAT(RefusalOf("group_name: a\ngoal_constraints: [" + goal + ", " + goal + "]\n"),
              HasSubstr("request.yaml:2: goal_constraints; got 2 goals; expected one goal"));
  EXPECT_THAT(RefusalOf("group_name: a\n"), HasSubstr("goal_constraints; got none"));
  EXPECT_THAT(RefusalOf("goal_constraints: [{}]\n"), HasSubstr("got no constraint"));
  EXPECT_THAT(RefusalOf("goal_constraints: [{orientation_constraints: [{}]}]\n"),
              HasSubstr("an orientation without a position"));
  std::string both = kPose;
  both += "    joint_constraints: [{joint_name: a, position: 0}]\n";
  EXPECT_THAT(RefusalOf(both), HasSubstr("two goals, of joints and of a pose"));
  EXPECT_THAT(RefusalOf("goal_constraints:\n  - joint_constraints:\n"
                        "      - {joint_name: a, position: 0}\n"
                        "      - {joint_name: a, position: 1}\n"),
              HasSubstr("request.yaml:4: goal_constraints[0].joint_constraints[1]; got joint 'a' a "
                        "second time"));
  EXPECT_THAT(RefusalOf("goal_constraints: [{joint_constraints: [{joint_name: a}]}]\n"),
              HasSubstr("joint_constraints[0].position; got none"));
  EXPECT_THAT(
      RefusalOf("goal_constraints: [{joint_constraints: [{joint_name: a, position: .nan}]}]\n"),
      HasSubstr("expected a finite number"));
}

TEST(MotionRequestTest, NamesAndPositionsAreAsMany) {
  EXPECT_THAT(RefusalOf("start_state:\n  joint_state: {name: [a], position: [0, 1]}\n"
                        "goal_constraints: []\n"),
              HasSubstr("request.yaml:2: start_state.joint_state; got 1 names and 2 positions"));
  EXPECT_THAT(RefusalOf("start_state: {joint_state: {name: [a, a], position: [0, 1]}}\n"),
              HasSubstr("got joint 'a' twice"));
  EXPECT_THAT(RefusalOf("start_state: {joint_state: {name: a, position: [0]}}\n"),
              HasSubstr("start_state.joint_state.name; got 'a'; expected a list"));
}

}  // namespace motion_request_test
}  // namespace oca::scenes
