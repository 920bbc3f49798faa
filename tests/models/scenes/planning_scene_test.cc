// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/planning_scene.h"

#include <gmock/gmock.h>

#include <string>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::scenes {
namespace planning_scene_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

PlanningScene Read(const std::string& text, const std::string& name = "scene.yaml") {
  const test::TemporaryFolder folder;
  return ReadPlanningScene(folder.Write(name, text));
}

std::string RefusalOf(const std::string& text, const std::string& name = "scene.yaml") {
  try {
    Read(text, name);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

/// A scene with one object; its first key stands in line 3.
std::string OfObject(const std::string& keys) {
  std::string text = "world:\n  collision_objects:\n";
  std::string line;
  bool first = true;
  for (const char c : keys + "\n") {
    if (c != '\n') {
      line += c;
      continue;
    }
    text += (first ? "    - " : "      ") + line + "\n";
    first = false;
    line.clear();
  }
  return text;
}

std::string OfPrimitive(const std::string& type, const std::string& dimensions) {
  return OfObject("id: a\nprimitives: [{type: " + type + ", dimensions: " + dimensions + "}]");
}

/// As MotionBenchMaker writes it: numbers in lists.
const char* const kLists = R"(robot_model_name: arm
robot_state:
  joint_state: {position: [0.1, -0.2], name: [j1, j2]}
  multi_dof_joint_state:
    joint_names: [virtual]
    transforms: [{translation: [1, 0, 0], rotation: [0, 0, 0, 1]}]
  attached_collision_objects:
    - link_name: hand
      touch_links: [finger]
      object:
        id: cup
        primitives: [{type: cylinder, dimensions: [0.1, 0.03]}]
        primitive_poses: [{position: [0, 0, 0.05], orientation: [0, 0, 0, 1]}]
allowed_collision_matrix:
  entry_names: [a, b, c]
  entry_values: [[false, true, false], [true, false, false], [false, false, false]]
  default_entry_names: [c]
  default_entry_values: [true]
name: ""
fixed_frame_transforms:
  - transform: {translation: [0, 0, 0.5], rotation: [0, 0, 0, 1]}
    child_frame_id: world
world:
  collision_objects:
    - id: shelf
      header: {frame_id: world}
      pose: {position: [1, 2, 3], orientation: [0, 0, 0.6, 0.8]}
      primitives:
        - {type: box, dimensions: [0.1, 0.2, 0.3]}
        - {type: cone, dimensions: [0.4, 0.5]}
      primitive_poses:
        - {position: [0, 0, 0], orientation: [0, 0, 0, 1]}
        - {position: [0, 0, 1], orientation: [0.5, 0.5, 0.5, 0.5]}
      subframe_names: [edge]
      subframe_poses: [{position: [0.05, 0, 0], orientation: [0, 0, 0, 1]}]
)";

TEST(PlanningSceneTest, IsReadAsMotionBenchMakerWritesIt) {
  const PlanningScene scene = Read(kLists);
  EXPECT_EQ(scene.robot, "arm");
  ASSERT_EQ(scene.objects.size(), 1U);
  const SceneObject& shelf = scene.objects[0];
  EXPECT_EQ(shelf.frame.text, "world");
  EXPECT_EQ(shelf.X_FO.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(shelf.X_FO.linear()(1, 0), 2.0 * 0.6 * 0.8, 1e-15);  // sin of twice the half angle
  ASSERT_EQ(shelf.bodies.size(), 2U);
  EXPECT_EQ(std::get<geometry::Box>(std::get<geometry::Shape>(shelf.bodies[0].shape)).size,
            Eigen::Vector3d(0.1, 0.2, 0.3));
  const auto& cone = std::get<geometry::Cone>(std::get<geometry::Shape>(shelf.bodies[1].shape));
  EXPECT_EQ(cone.length, 0.4);
  EXPECT_EQ(cone.radius, 0.5);
  EXPECT_EQ(shelf.bodies[1].X_OB.translation().z(), 1.0);
  ASSERT_EQ(shelf.subframes.size(), 1U);
  EXPECT_EQ(shelf.subframes[0].name, "edge");
  ASSERT_EQ(scene.held.size(), 1U);
  EXPECT_EQ(scene.held[0].link.text, "hand");
  ASSERT_EQ(scene.held[0].touch_links.size(), 1U);
  EXPECT_EQ(scene.held[0].touch_links[0].text, "finger");
  EXPECT_THAT(scene.held[0].touch_links[0].where, HasSubstr(".yaml:9"));
  EXPECT_EQ(*scene.joints.Find("j2"), -0.2);
  EXPECT_EQ(scene.joints.Find("j3"), nullptr);
  EXPECT_EQ(scene.joints.bases.at(0).X_PF.translation().x(), 1.0);
  EXPECT_THAT(scene.allowed.pairs, ElementsAre(std::pair<std::string, std::string>("a", "b")));
  EXPECT_THAT(scene.allowed.defaults, ElementsAre("c"));
  EXPECT_EQ(scene.frames.at(0).X_PF.translation().z(), 0.5);
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(PlanningSceneTest, IsReadAsMessagesPrint) {
  const PlanningScene scene = Read(R"(
name: mine
is_diff: false
robot_state: {joint_state: {header: {frame_id: ''}, name: [], position: [], velocity: []}}
allowed_collision_matrix:
  entry_names: [a, b]
  entry_values: [{enabled: [false, true]}, {enabled: [true, false]}]
world:
  collision_objects:
    - header: {stamp: {sec: 0, nanosec: 0}, frame_id: /base}
      pose: {position: {x: 0.0, y: 0.0, z: 1.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}
      id: ball
      type: {key: '', db: ''}
      primitives:
        - {type: 2, dimensions: [0.25], polygon: {points: []}}
      primitive_poses:
        - position: {x: 0.5, y: 0.0, z: 0.0}
          orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
      meshes:
        - triangles: [{vertex_indices: [0, 1, 2]}]
          vertices: [{x: 0, y: 0, z: 0}, {x: 1, y: 0, z: 0}, {x: 0, y: 1, z: 0}]
      mesh_poses: []
      planes: [{coef: [0, 0, 2, -1]}]
      plane_poses: []
      operation: 0
  octomap: {octomap: {data: []}}
)");
  EXPECT_THAT(scene.allowed.pairs, ElementsAre(std::pair<std::string, std::string>("a", "b")));
  const SceneObject& ball = scene.objects.at(0);
  EXPECT_EQ(ball.frame.text, "base");
  ASSERT_EQ(ball.bodies.size(), 3U);
  EXPECT_EQ(std::get<geometry::Sphere>(std::get<geometry::Shape>(ball.bodies[0].shape)).radius,
            0.25);
  EXPECT_EQ(std::get<geometry::TriangleMesh>(ball.bodies[1].shape).vertices.size(), 3U);
  EXPECT_EQ(std::get<ScenePlane>(ball.bodies[2].shape).offset, 0.5);  // 2 z = 1
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(PlanningSceneTest, ATextOfMoveItIsReadWithAndWithoutPosesOfObjects) {
  const PlanningScene scene = Read(
      "my scene\n* a box\n0.5 0 0\n0 0 0 1\n2\nbox\n1 2 3\n0 0 0.5\n0 0 0 1\n0 0 0 0\n"
      "cylinder\n0.1 0.4\n0 0 0\n0 0 1 0\n1 0 0 1\n1\ntop\n0 0 1\n0 0 0 1\n"
      "* m\n0 0 0\n0 0 0 1\n1\nmesh\n3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 2\n0 0 0\n0 0 0 1\n0 0 0 0\n0\n"
      ".\n",
      "a.scene");
  EXPECT_EQ(scene.name, "my scene");
  ASSERT_EQ(scene.objects.size(), 2U);
  const SceneObject& box = scene.objects[0];
  EXPECT_EQ(box.id, "a box");
  EXPECT_EQ(box.X_FO.translation().x(), 0.5);
  EXPECT_EQ(box.bodies[0].X_OB.translation().z(), 0.5);
  // The text has the radius first, the message the height.
  const auto& round = std::get<geometry::Cylinder>(std::get<geometry::Shape>(box.bodies[1].shape));
  EXPECT_EQ(round.radius, 0.1);
  EXPECT_EQ(round.length, 0.4);
  EXPECT_EQ(box.subframes.at(0).name, "top");
  EXPECT_THAT(box.where, HasSubstr("a.scene:2"));

  const PlanningScene old = Read(
      "(noname)+\n* s\n1\nsphere\n0.2\n1 2 3\n0 0 0 1\n0 0 0 0\n* t\n1\ncone\n0.3 0.6\n0 0 0\n"
      "0 0 0 1\n0 0 0 0\n.\n",
      "b.scene");
  ASSERT_EQ(old.objects.size(), 2U);
  EXPECT_EQ(old.objects[0].X_FO.translation().norm(), 0.0);
  EXPECT_EQ(old.objects[0].bodies[0].X_OB.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(
      std::get<geometry::Cone>(std::get<geometry::Shape>(old.objects[1].bodies[0].shape)).length,
      0.6);
}

TEST(PlanningSceneTest, SizesAreCheckedAtTheirLine) {
  EXPECT_EQ(RefusalOf(OfPrimitive("box", "[1, 1, 1]")), "accepted");
  EXPECT_THAT(RefusalOf(OfPrimitive("boxx", "[1, 1, 1]")),
              AllOf(HasSubstr("scene.yaml:4: world.collision_objects[0].primitives[0]: type of "
                              "primitive; got 'boxx'"),
                    HasSubstr("nearest is 'box'")));
  EXPECT_THAT(RefusalOf(OfPrimitive("5", "[1]")), HasSubstr("type of primitive; got '5'"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, 1]")),
              HasSubstr("dimensions of a box; got 2 numbers; expected 3 edge lengths"));
  EXPECT_THAT(RefusalOf(OfPrimitive("sphere", "[1, 1]")),
              HasSubstr("dimensions of a sphere; got 2 numbers"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, 0, 1]")),
              HasSubstr("scene.yaml:4: world.collision_objects[0].primitives[0]: dimensions of a "
                        "box; got 0; expected numbers above 0"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, -1, 1]")), HasSubstr("got -1"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, .inf, 1]")),
              HasSubstr("dimensions[1]; got '.inf'; expected a finite number"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, nan, 1]")), HasSubstr("got 'nan'"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, wide, 1]")), HasSubstr("got 'wide'"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "[1, '1', 1]")), HasSubstr("expected a finite number"));
  EXPECT_THAT(RefusalOf(OfPrimitive("box", "3")), HasSubstr("expected a list of numbers"));
}

TEST(PlanningSceneTest, RotationsAreOfLengthOneToThreeDigits) {
  const auto with = [](const std::string& orientation) {
    return RefusalOf(
        OfObject("id: a\nprimitives: [{type: sphere, dimensions: [1]}]\n"
                 "primitive_poses: [{position: [0, 0, 0], orientation: " +
                 orientation + "}]"));
  };
  EXPECT_EQ(with("[0, 0, 0.707, 0.707]"), "accepted");
  EXPECT_EQ(with("{x: 0, y: 0, z: 0.7071068, w: -0.7071068}"), "accepted");
  EXPECT_THAT(with("[0, 0, 0, 0]"), AllOf(HasSubstr("scene.yaml:5: "), HasSubstr("got 0; ")));
  EXPECT_THAT(with("[0, 0, 0, 1.01]"), HasSubstr("expected 1, a unit quaternion"));
  EXPECT_THAT(with("[0, 0, 1]"), HasSubstr("got 3 numbers; expected 4"));
  EXPECT_THAT(with("{x: 0, y: 0, z: 1}"), HasSubstr("orientation.w; got none"));
  EXPECT_THAT(with("[0, 0, 0, inf]"), HasSubstr("a finite number"));
}

TEST(PlanningSceneTest, WhatDoesNotFitTogetherIsRefused) {
  EXPECT_THAT(RefusalOf(OfObject("id: a\nprimitives: [{type: sphere, dimensions: [1]}]\n"
                                 "primitive_poses: [{position: [0, 0, 0]}, {}]")),
              HasSubstr("primitive_poses; got 2 poses; expected 1, one of each of primitives"));
  EXPECT_THAT(RefusalOf(OfObject("id: a")), HasSubstr("got no shape"));
  EXPECT_THAT(RefusalOf(OfObject("id: ''\nprimitives: [{type: sphere, dimensions: [1]}]")),
              HasSubstr("expected a name"));
  EXPECT_THAT(RefusalOf(OfObject("primitives: [{type: sphere, dimensions: [1]}]")),
              HasSubstr("scene.yaml:3: world.collision_objects[0].id; got none"));
  EXPECT_THAT(RefusalOf(OfObject("id: a\noperation: 1\n"
                                 "primitives: [{type: sphere, dimensions: [1]}]")),
              HasSubstr("scene.yaml:4: world.collision_objects[0].operation; got '1'"));
  const std::string one = "{id: a, primitives: [{type: sphere, dimensions: [1]}]}";
  EXPECT_THAT(RefusalOf("world:\n  collision_objects:\n    - " + one + "\n    - " + one + "\n"),
              HasSubstr("scene.yaml:4: world.collision_objects[1]; got the id 'a' a second time"));
  EXPECT_THAT(RefusalOf("world: {collision_objects: {a: 1}}\n"), HasSubstr("expected a list"));
  EXPECT_THAT(RefusalOf("world: 3\n"), HasSubstr("expected a map"));
  EXPECT_THAT(RefusalOf("goal_constraints: []\n"), HasSubstr("expected a planning scene"));
  EXPECT_THAT(
      RefusalOf(OfObject("id: a\nmeshes: [{vertices: [[0, 0, 0]], triangles: [[0, 0, 1]]}]")),
      HasSubstr("got vertex 1; expected one of the 1 vertices"));
  EXPECT_THAT(RefusalOf(OfObject("id: a\nplanes: [{coef: [0, 0, 0, 1]}]")),
              HasSubstr("plane; got"));
  EXPECT_THAT(RefusalOf("world: {}\nrobot_state: {joint_state: {name: [a, b], position: [1]}}\n"),
              HasSubstr("scene.yaml:2: robot_state.joint_state; got 2 names and 1 positions"));
  EXPECT_THAT(
      RefusalOf("world: {}\nallowed_collision_matrix:\n  {entry_names: [a], entry_values: []}\n"),
      HasSubstr("got 0 rows for 1 names"));
}

TEST(PlanningSceneTest, AllThatIsWrongWithObjectsIsToldAtOnce) {
  const std::string refusal = RefusalOf(
      "world:\n  collision_objects:\n    - {id: a}\n"
      "    - {id: b, primitives: [{type: cube, dimensions: [1]}]}\n");
  EXPECT_THAT(refusal, AllOf(HasSubstr("scene.yaml:3: "), HasSubstr("scene.yaml:4: ")));
}

TEST(PlanningSceneTest, WhatIsNoSceneOrTooDeepIsRefusedWithItsLine) {
  EXPECT_THAT(RefusalOf("a: [\n"), HasSubstr("scene.yaml:"));
  EXPECT_THAT(RefusalOf("world: {}\nworld: {}\n"),
              HasSubstr("scene.yaml:2: key 'world'; got it twice"));
  EXPECT_THAT(RefusalOf("a: &x 1\nb: *x\n"), HasSubstr("scene.yaml:2: an alias"));
  std::string deep = "world: ";
  for (int i = 0; i < 100; ++i) deep += "{a: ";
  EXPECT_THAT(RefusalOf(deep + "1" + std::string(100, '}') + "\n"),
              HasSubstr("nested deeper than 64 levels"));
  EXPECT_THAT(RefusalOf("world: \xff\n"), HasSubstr("is not UTF-8"));
  EXPECT_THAT([] { ReadPlanningScene("/nowhere.yaml"); },
              testing::ThrowsMessage<models::ModelError>(HasSubstr("/nowhere.yaml")));
  EXPECT_THAT(RefusalOf(std::string(33'000'000, ' ')), HasSubstr("too large"));
}

TEST(PlanningSceneTest, WhatATextHasWrongIsRefusedWithItsLine) {
  const auto of = [](const std::string& shape) {
    return RefusalOf("x\n* a\n1\n" + shape + "\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n", "c.scene");
  };
  EXPECT_EQ(of("box\n1 1 1"), "accepted");
  EXPECT_THAT(of("cube\n1"), HasSubstr("c.scene:4: type of primitive; got 'cube'"));
  EXPECT_THAT(of("box\n1 0 1"), HasSubstr("got 0; expected numbers above 0"));
  EXPECT_THAT(of("box\n1 1"), HasSubstr("c.scene:"));
  EXPECT_THAT(RefusalOf("x\n* a\n1\nsphere\n1\n0 0 0\n0 0 0 0\n0 0 0 0\n.\n", "c.scene"),
              HasSubstr("c.scene:7: quaternion: length; got 0"));
  EXPECT_THAT(RefusalOf("x\n* a\n1\nsphere\n1\n0 0 0\n0 0 0 1\n0 0 0 0\n* a\n.\n", "c.scene"),
              HasSubstr("got a twice"));
  EXPECT_THAT(RefusalOf("x\n* a\n1\nsphere\n1\n", "c.scene"), HasSubstr("the end of the file"));
  EXPECT_THAT(RefusalOf("x\n* a\n99999999\n", "c.scene"),
              HasSubstr("number of shapes; got 99999999"));
  EXPECT_THAT(RefusalOf("x\n+ a\n", "c.scene"), HasSubstr("c.scene:2: marker; got +"));
}

TEST(PlanningSceneTest, WhatASceneSaysBesideIsToldByName) {
  const PlanningScene scene = Read(
      "world: {collision_objects: [], octomap: {data: [1, 2]}}\n"
      "link_padding: [{link_name: hand, padding: 0.01}, {link_name: arm, padding: 0}]\n"
      "link_scale: [{link_name: hand, scale: 1.0}]\n"
      "weather: fine\n");
  EXPECT_THAT(scene.notes,
              ElementsAre(HasSubstr("scene.yaml:4: weather: not known here"),
                          HasSubstr("world.octomap: not taken over"),
                          HasSubstr("scene.yaml:2: link_padding of 'hand': 0.01 not taken over")));
}

}  // namespace planning_scene_test
}  // namespace oca::scenes
