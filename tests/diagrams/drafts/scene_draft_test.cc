// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::drafts {
namespace scene_draft_test {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::string TextOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Three joints, a finger that slides, and one that is fixed.
std::string ArmUrdf() {
  std::string text = "<robot name='arm3'><link name='base'/>";
  const auto add = [&](const std::string& name, const std::string& parent, const std::string& rest,
                       const std::string& type) {
    text += "<link name='" + name +
            "'><collision><origin xyz='0 0 0.15'/><geometry><cylinder radius='0.03' length='0.2'/>"
            "</geometry></collision></link><joint name='" +
            name + "_joint' type='" + type + "'><parent link='" + parent + "'/><child link='" +
            name + "'/>" + rest + "</joint>";
  };
  const std::string limit = "<limit lower='-2' upper='2' velocity='2' effort='1' ";
  add("one", "base", "<axis xyz='0 1 0'/>" + limit + "acceleration='5'/>", "revolute");
  add("two", "one", "<origin xyz='0 0 0.3'/><axis xyz='0 1 0'/>" + limit + "/>", "revolute");
  add("hand", "two", "<origin xyz='0 0 0.3'/><axis xyz='1 0 0'/>" + limit + "/>", "revolute");
  add("left", "hand",
      "<origin xyz='0.1 0 0.3'/><axis xyz='1 0 0'/><limit lower='0' upper='0.04' velocity='1' "
      "effort='1'/>",
      "prismatic");
  add("right", "hand", "<origin xyz='-0.1 0 0.3'/>", "fixed");
  return text + "</robot>";
}

const char* const kSrdf =
    "<robot name='arm3'>"
    "<virtual_joint name='stand' type='fixed' parent_frame='world' child_link='base'/>"
    "<group name='arm'><joint name='one_joint'/><joint name='two_joint'/>"
    "<joint name='hand_joint'/></group>"
    "<disable_collisions link1='left' link2='right' reason='Never'/>"
    "<disable_collisions link1='one' link2='hand' reason='Never'/>"
    "<disable_collisions link1='two' link2='left' reason='Never'/>"
    "<disable_collisions link1='two' link2='right' reason='Never'/>"
    "<disable_collisions link1='one' link2='left' reason='Never'/>"
    "<disable_collisions link1='one' link2='right' reason='Never'/></robot>";

const char* const kRequest = R"(group_name: arm
start_state:
  joint_state:
    name: [one_joint, two_joint, hand_joint, left_joint, right_joint]
    position: [0, 0.5, 0, 0.03, 0.065]
goal_constraints:
  - joint_constraints:
      - {joint_name: one_joint, position: 1}
      - {joint_name: two_joint, position: 0.5}
      - {joint_name: hand_joint, position: 0}
)";

class SceneDraftTest : public testing::Test {
 protected:
  SceneDraftTest() {
    options_.draft.robot = folder_.Write("arm.urdf", ArmUrdf());
    options_.draft.srdf = folder_.Write("arm.srdf", kSrdf);
    options_.diagram = folder_.path() / "task.yaml";
  }
  SceneDraft Make(const std::string& scene, const std::string& request = kRequest) {
    options_.scene = folder_.Write("scene.yaml", scene);
    if (!request.empty()) options_.request = folder_.Write("request.yaml", request);
    SceneDraft draft = DraftScene(options_);
    text_ = TextOf(options_.diagram);
    return draft;
  }
  std::string RefusalOf(const std::string& scene, const std::string& request = kRequest) {
    try {
      Make(scene, request);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
  test::TemporaryFolder folder_;
  SceneDraftOptions options_;
  std::string text_;
};

std::string Object(const std::string& keys) {
  return "world: {collision_objects: [{" + keys + "}]}\n";
}

TEST_F(SceneDraftTest, LoadsWithTheArmOfTheGroupAndTheRestWhereTheStartHasIt) {
  const SceneDraft draft =
      Make(Object("id: box, header: {frame_id: world}, pose: {position: [2, 0, 0]}, "
                  "primitives: [{type: box, dimensions: [0.1, 0.2, 0.3]}]"));
  EXPECT_EQ(draft.robot.model->num_positions(), 3);
  EXPECT_THAT(text_,
              AllOf(HasSubstr("group: \"arm\""), HasSubstr("\"left_joint\": 0.03"),
                    HasSubstr("{id: box, shape: {type: box, size: [0.1, 0.2, 0.3]}, "
                              "pose: {xyz: [2, 0, 0]}}"),
                    HasSubstr("acceleration_limits: [5, \"${acceleration_limit}\", "
                              "\"${acceleration_limit}\"]"),
                    HasSubstr("kind: quintic"), HasSubstr("{time: 6, position: [1, 0.5, 0]}"),
                    HasSubstr("avoidance: recommended")));
  EXPECT_THAT(draft.left_out, Contains(AllOf(HasSubstr("joint 'right_joint' at 0.065"),
                                             HasSubstr("the model has it fixed"))));
  EXPECT_THAT(draft.left_out, Not(Contains(HasSubstr("left_joint"))));
  const loading::LoadedDiagram loaded = loading::LoadDiagram(options_.diagram);
  EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings.front();
}

TEST_F(SceneDraftTest, PutsObjectsWhereLinksAndSubframesAre) {
  const SceneDraft draft = Make(
      "world:\n  collision_objects:\n"
      "    - {id: tray, header: {frame_id: hand}, primitives: [{type: sphere, dimensions: "
      "[0.1]}],\n"
      "       primitive_poses: [{position: [0, 0, 1]}], subframe_names: [rim],\n"
      "       subframe_poses: [{position: [0, 0, 2]}]}\n"
      "    - {id: cup, header: {frame_id: tray/rim}, primitives: [{type: cone, dimensions: [1, "
      "2]}]}\n",
      "group_name: arm\n"
      "goal_constraints: [{joint_constraints: [{joint_name: one_joint, position: 0}, "
      "{joint_name: two_joint, position: 0}, {joint_name: hand_joint, position: 0}]}]\n"
      "start_state: {joint_state: {name: [one_joint, two_joint, hand_joint], position: [0, 0, "
      "0]}}\n");
  // The hand stands 0.6 m above the base.
  EXPECT_THAT(text_, AllOf(HasSubstr("{type: sphere, radius: 0.1}, pose: {xyz: [0, 0, 1.6]}"),
                           HasSubstr("{type: cone, radius: 2, length: 1}, pose: {xyz: [0, 0, "
                                     "2.6]}")));
  EXPECT_THAT(draft.decided, Contains(HasSubstr("in the frame of 'hand', which moves")));
}

TEST_F(SceneDraftTest, MakesFilesOfMeshesHalfSpacesOfPlanesAndACompoundOfPrimitives) {
  const std::string tetrahedron =
      "{vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "
      "triangles: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]}";
  const SceneDraft draft = Make(
      "world:\n  collision_objects:\n"
      "    - {id: rock, meshes: [" +
      tetrahedron +
      "], mesh_poses: [{position: [3, 0, 0]}]}\n"
      "    - {id: floor, planes: [{coef: [0, 0, -1, -0.2]}]}\n"
      "    - {id: pair, primitives: [{type: sphere, dimensions: [0.1]}, {type: sphere, dimensions: "
      "[0.2]}], primitive_poses: [{position: [2, 0, 0]}, {position: [2, 1, 0]}]}\n");
  EXPECT_EQ(draft.files.size(), 2U);
  EXPECT_EQ(draft.files[1].filename(), "task_rock.obj");
  EXPECT_THAT(TextOf(draft.files[1]), HasSubstr("f 2 3 4\n"));
  EXPECT_THAT(text_, AllOf(HasSubstr("{type: mesh, file: \"task_rock.obj\"}"),
                           // -z = 0.2: below it is solid, as the arm is above.
                           HasSubstr("{type: half_space}, pose: {xyz: [0, 0, -0.2]}"),
                           HasSubstr("type: compound")));
  EXPECT_NO_THROW(loading::LoadDiagram(options_.diagram));
}

TEST_F(SceneDraftTest, HoldsWhatIsAttachedAndIgnoresWhatMayTouch) {
  const SceneDraft draft = Make(R"(
robot_state:
  attached_collision_objects:
    - link_name: hand
      touch_links: [left, right]
      object:
        id: stick
        header: {frame_id: hand}
        primitives: [{type: box, dimensions: [0.02, 0.02, 0.2]}]
        primitive_poses: [{position: [0, 0, 0.4]}]
allowed_collision_matrix:
  entry_names: [one, two, hand, stick, wall]
  entry_values:
    - [false, true, true, false, true]
    - [true, false, true, true, false]
    - [true, true, false, false, false]
    - [false, true, false, false, true]
    - [true, false, false, true, false]
world:
  collision_objects: [{id: wall, pose: {position: [3, 0, 0]}, primitives: [{type: box, dimensions: [0.1, 1, 1]}]}]
)");
  EXPECT_EQ(draft.held, 1);
  EXPECT_THAT(text_,
              AllOf(HasSubstr("- id: stick\n        link: hand\n        touches: [left, right, "
                              "two]"),
                    HasSubstr("- [one, wall]"), HasSubstr("- [stick, wall]")));
  // Neighbours and pairs of the SRDF need no word.
  EXPECT_THAT(text_, Not(HasSubstr("arm/")));
  EXPECT_NO_THROW(loading::LoadDiagram(options_.diagram));
}

TEST_F(SceneDraftTest, TakesAsLongAsTheLimitsWant) {
  std::string slow = ArmUrdf();
  for (std::size_t at = 0; (at = slow.find("velocity='2'", at)) != std::string::npos;) {
    slow.replace(at, 12, "velocity='0.02'");
  }
  options_.draft.robot = folder_.Write("slow.urdf", slow);
  Make("world: {}\n");
  // 1.875 times 1 rad at 0.02 rad/s.
  EXPECT_THAT(text_, HasSubstr("{time: 94, position: [1, "));
}

TEST_F(SceneDraftTest, AGoalBeyondALimitIsRefusedButForItsDigits) {
  std::string request = kRequest;
  const std::size_t at = request.find("position: 1}");
  request.replace(at, 12, "position: 2.1}");
  EXPECT_THAT(RefusalOf("world: {}\n", request),
              HasSubstr("request.yaml:7: goal_constraints[0]: joint 'one_joint'; got 2.1; expected "
                        "a position within its limits, -2 to 2"));
  EXPECT_FALSE(std::filesystem::exists(options_.diagram));
  request.replace(at, 14, "position: 2.00005}");
  EXPECT_EQ(RefusalOf("world: {}\n", request), "accepted");
}

TEST_F(SceneDraftTest, AStartBeyondALimitIsTold) {
  std::string request = kRequest;
  request.replace(request.find("[0, 0.5, 0,"), 11, "[2.1, 0.5, 0,");
  EXPECT_THAT(Make("world: {}\n", request).decided,
              Contains(HasSubstr("start_state: joint 'one_joint' at 2.1 is beyond its limits")));
}

TEST_F(SceneDraftTest, WhatCannotBeLoadedIsRefusedAtTheRequest) {
  const std::string pose = R"(group_name: arm
start_state: {joint_state: {name: [one_joint, two_joint, hand_joint], position: [0, 0.5, 0]}}
goal_constraints:
  - position_constraints:
      - link_name: hand
        constraint_region:
          primitives: [{type: sphere, dimensions: [0.001]}]
          primitive_poses: [{position: [9, 9, 9], orientation: [0, 0, 0, 1]}]
)";
  EXPECT_THAT(RefusalOf("world: {}\n", pose),
              AllOf(HasSubstr("request.yaml:5: makes a diagram that cannot be loaded: "),
                    HasSubstr("out of reach")));
  EXPECT_FALSE(std::filesystem::exists(options_.diagram));
}

TEST_F(SceneDraftTest, WritesAnSrdfWhereNothingAllowsCollisions) {
  options_.draft.srdf.clear();
  // Without a group the finger that slides is taken for a joint of the arm.
  std::string request = kRequest;
  request += "      - {joint_name: left_joint, position: 0.02}\n";
  const SceneDraft draft = Make("world: {}\n", request);
  EXPECT_EQ(draft.robot.model->num_positions(), 4);
  EXPECT_THAT(TextOf(folder_.path() / "task.srdf"), HasSubstr("disable_collisions"));
  EXPECT_THAT(text_, HasSubstr("srdf: \"task.srdf\""));
  EXPECT_THAT(draft.decided, Contains(HasSubstr("group 'arm': no SRDF says what it is")));
  EXPECT_NO_THROW(loading::LoadDiagram(options_.diagram));
}

TEST_F(SceneDraftTest, WhatIsMissingOrUnknownIsRefusedAndLeavesNoFile) {
  EXPECT_THAT(
      RefusalOf(Object("id: a, header: {frame_id: wrld}, primitives: [{type: sphere, "
                       "dimensions: [1]}]")),
      AllOf(HasSubstr("scene.yaml:1: frame; got 'wrld'"), HasSubstr("did you mean 'world'?")));
  EXPECT_THAT(RefusalOf("world: {}\n", "group_name: arms\n" + std::string(kRequest).substr(16)),
              AllOf(HasSubstr("group_name; got 'arms'"), HasSubstr("did you mean 'arm'?")));
  std::string less = kRequest;
  less.replace(less.find("hand_joint, position"), 10, "other_one_");
  EXPECT_THAT(RefusalOf("world: {}\n", less),
              AllOf(HasSubstr("request.yaml:7: goal_constraints[0]: joint 'hand_joint'; got none"),
                    HasSubstr("joint 'other_one_'; got a name that the robot does not have; "
                              "expected one of its joints")));
  EXPECT_THAT(RefusalOf("world: {}\n",
                        "group_name: arm\ngoal_constraints: [{joint_constraints: [{joint_name: "
                        "one_joint, position: 0}]}]\n"),
              HasSubstr("start_state: joint 'one_joint'; got none"));
  EXPECT_FALSE(std::filesystem::exists(options_.diagram));
}

}  // namespace scene_draft_test
}  // namespace oca::drafts
