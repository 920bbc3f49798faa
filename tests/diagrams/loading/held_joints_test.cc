// SPDX-License-Identifier: BSD-3-Clause
// `held`, `group` and `joint_limits` of models, and postures by names.
#include <gmock/gmock.h>

#include <string>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/loading/nested_files.h"
#include "tests/models/robot/gripper_arm.h"

namespace oca::loading {
namespace held_joints_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class HeldJointsTest : public nested_files::NestedFiles {
 protected:
  HeldJointsTest() {
    folder.Write("arm.urdf", robot::test::kGripperArmUrdf);
    folder.Write("arm.srdf", robot::test::kGripperArmSrdf);
  }
  /// Line 1 is the model, 2 begins the key points, which are in lines of their own from 4 on.
  static std::string Diagram(const std::string& model, const std::string& points,
                             const std::string& start = "0") {
    return "models: {arm: {urdf: arm.urdf, srdf: arm.srdf" + model +
           "}}\n"
           "systems:\n"
           "  spline: {type: SplineGenerator, key_points: [\n" +
           points +
           "]}\n"
           "  plant: {type: IntegratorPlant, initial_position: " +
           start +
           "}\n"
           "  kinematics: {type: RobotKinematics, model: arm}\n"
           "  gain: {type: Gain, gain: 0}\n"
           "connections:\n"
           "  - spline.position -> kinematics.position\n"
           "  - plant.position -> gain.in\n"
           "  - spline.velocity -> plant.command\n";
  }
  static Eigen::VectorXd Goal(const LoadedDiagram& loaded) { return Output(loaded, "spline.goal"); }
  static Eigen::VectorXd Output(const LoadedDiagram& loaded, const std::string& output) {
    const Context context = loaded.diagram->MakeContext();
    return loaded.diagram->GetOutput<Vector>(output).Eval(context);
  }
};

constexpr const char* kTwo = "{time: 0, position: [0, 0.2]}, {time: 1, position: [1, 2]}";

TEST_F(HeldJointsTest, HeldJointsAreNoneOfTheRobotsPositions) {
  const auto positions = [&](const std::string& model) {
    return Load(Diagram(model, kTwo)).models.Get("arm")->num_positions();
  };
  EXPECT_EQ(positions(", held: {left_slide: 0.02, roll: 0}"), 2);
  EXPECT_EQ(positions(", group: arm"), 2);
  EXPECT_EQ(positions(", group: arm, held: {hand: open}"), 2);
  EXPECT_THAT(Refusal(Diagram(", held: {left_slide: 0.02}", kTwo)), HasSubstr("expected 3"));
}

TEST_F(HeldJointsTest, ABlueprintTellsHowJointsAreHeldApart) {
  folder.Write("d.yaml", "parameters: {at: 0}\n" +
                             Diagram(", group: arm, held: {left_slide: \"${at}\"}", kTwo));
  const Blueprint blueprint((folder.path() / "d.yaml").string());
  const auto y = [&](const char* at) {
    const auto model = blueprint.Build({{"parameters.at", at}}).models.Get("arm");
    return model->joints()[model->FindJoint("right_slide")].X_PJ.translation().y();
  };
  EXPECT_DOUBLE_EQ(y("0"), -0.01);
  EXPECT_DOUBLE_EQ(y("0.04"), -0.03);
  EXPECT_DOUBLE_EQ(y("0"), -0.01);
}

TEST_F(HeldJointsTest, MistakesAreToldWhereTheyAre) {
  const auto refusal = [&](const std::string& model) { return Refusal(Diagram(model, kTwo)); };
  // `models: {arm: {urdf: arm.urdf, srdf: arm.srdf` is 45 characters long.
  EXPECT_THAT(
      refusal(", held: {elbow: 5}"),
      HasSubstr("d.yaml:1:62: error: models.arm: held.elbow: got 5 rad; expected 0.1 to 2.2"));
  EXPECT_THAT(refusal(", group: amr"),
              HasSubstr("d.yaml:1:55: error: models.arm: group: unknown group; got 'amr'"));
  EXPECT_THAT(refusal(", held: {elbow: [1]}"),
              HasSubstr("d.yaml:1:62: error: models.arm.held.elbow: got a list; expected where the "
                        "joint is"));
  EXPECT_THAT(refusal(", held: elbow"), HasSubstr("expected a map of joints"));
  folder.Write("limits.yaml", "joint_limits:\n  elbow: {max_velocity: no}\n");
  EXPECT_THAT(refusal(", group: arm, joint_limits: limits.yaml"),
              AllOf(HasSubstr("d.yaml:1:74: error: models.arm: "),
                    HasSubstr("limits.yaml:2: joint 'elbow': max_velocity; got 'no'")));
}

TEST_F(HeldJointsTest, MistakesOfSrdfAndLimitsAreToldAtOnceEachAtItsFile) {
  folder.Write("arm.srdf",
               "<robot name='gripper_arm'>\n  <disable_collisions link1='a'/>\n</robot>");
  folder.Write("limits.yaml", "joint_limits:\n  elbwo: {max_velocity: 1}\n  rol: {}\n");
  EXPECT_THAT(Refusal(Diagram(", joint_limits: limits.yaml", kTwo)),
              AllOf(HasSubstr("d.yaml:1:38: error: models.arm: "), HasSubstr("arm.srdf:2"),
                    HasSubstr("d.yaml:1:62: error: models.arm: "),
                    HasSubstr("limits.yaml:2: unknown joint; got 'elbwo'"),
                    HasSubstr("limits.yaml:3: unknown joint; got 'rol'")));
}

TEST_F(HeldJointsTest, AllJointsThatCannotBeHeldAreToldAtOnce) {
  EXPECT_THAT(Refusal(Diagram(", held: {elbow: 5, elbo: 0, hand: opne}", kTwo)),
              AllOf(HasSubstr("held.elbow: got 5 rad"), HasSubstr("held.elbo: got no joint"),
                    HasSubstr("held.hand: unknown state; got 'opne'")));
}

TEST_F(HeldJointsTest, LimitsOfAFileCount) {
  folder.Write("limits.yaml", "joint_limits:\n  elbow: {max_velocity: 0.5}\n");
  const auto model =
      Load(Diagram(", group: arm, joint_limits: limits.yaml", kTwo)).models.Get("arm");
  EXPECT_EQ(model->velocity_limits(), Eigen::Vector2d(2.0, 0.5));
}

TEST_F(HeldJointsTest, AModelThatIsGivenToAFileIsHeldThere) {
  folder.Write("inner.yaml",
               "models: {arm: {urdf: arm.urdf}}\n"
               "systems:\n"
               "  spline: {type: SplineGenerator, key_points: [{time: 0, position: ready}]}\n"
               "  kinematics: {type: RobotKinematics, model: arm}\n"
               "connections: [spline.position -> kinematics.position]\n");
  const LoadedDiagram loaded = Load(
      "models: {left: {urdf: arm.urdf, srdf: arm.srdf, group: arm}, frame: {urdf: arm.urdf, held: "
      "{shoulder: 0, elbow: 1, left_slide: 0, roll: 0}}}\n"
      "systems: {left: {type: Diagram, file: inner.yaml, models: {arm: left}}}\n");
  EXPECT_EQ(loaded.models.Get("left")->num_positions(), 2);
  EXPECT_EQ(Output(loaded, "left.spline.goal"), Eigen::Vector2d(0.3, 1.2));
}

TEST_F(HeldJointsTest, PosturesMayBeNames) {
  const LoadedDiagram loaded = Load(Diagram(", group: arm",
                                            "{time: 0, position: ready},\n"
                                            "{time: 1, position: {elbow: 2}},\n"
                                            "{time: 2, position: {shoulder: -1}}",
                                            "{shoulder: 0.5}"));
  EXPECT_EQ(Output(loaded, "spline.position"), Eigen::Vector2d(0.3, 1.2));
  EXPECT_EQ(Goal(loaded), Eigen::Vector2d(-1.0, 2.0));
  EXPECT_EQ(Output(loaded, "plant.position"), Eigen::Vector2d(0.5, 0.1));
  const LoadedDiagram first =
      Load(Diagram(", group: arm", "{time: 0, position: {shoulder: 1}}", "bent"));
  EXPECT_EQ(Goal(first), Eigen::Vector2d(1.0, 0.1));
  EXPECT_EQ(Output(first, "plant.position"), Eigen::Vector2d(0.0, 2.0));
}

TEST_F(HeldJointsTest, NamesThatAreWrongAreToldAtTheKeyPoint) {
  EXPECT_THAT(Refusal(Diagram(", group: arm",
                              "{time: 0, position: ready},\n"
                              "{time: 1, position: redy}")),
              AllOf(HasSubstr("d.yaml:5:21: error: systems.spline: key_points[1].position: got "
                              "'redy'; expected a state of 'gripper_arm'"),
                    HasSubstr("nearest is 'ready'")));
  EXPECT_THAT(Refusal(Diagram(", group: arm", "{time: 0, position: {elbwo: 1}}")),
              HasSubstr("d.yaml:4:21: error: systems.spline: key_points[0].position: got 'elbwo'; "
                        "expected joints of 'gripper_arm': shoulder, elbow; nearest is 'elbow'"));
  EXPECT_THAT(Refusal(Diagram(", group: arm", "{time: 0, position: {elbow: up}}")),
              HasSubstr("key_points[0].position.elbow: got 'up'; expected a number"));
  EXPECT_THAT(Refusal(Diagram(", group: arm", kTwo, "redy")),
              HasSubstr("d.yaml:5:52: error: systems.plant: initial_position: got 'redy'"));
}

TEST_F(HeldJointsTest, AWrongNumberOfJointsIsOneErrorAtTheKeyPoint) {
  const std::string three = Refusal(Diagram(", group: arm",
                                            "{time: 0, position: [0, 0.2, 0]},\n"
                                            "{time: 1, position: [0, 0.2, 1]}"));
  EXPECT_THAT(three,
              HasSubstr("d.yaml:4:21: error: systems.spline.key_points[0].position: got 3 "
                        "numbers; expected 2, one a joint of 'gripper_arm': shoulder, elbow"));
  EXPECT_EQ(std::count(three.begin(), three.end(), '\n'), 0) << three;
  const std::string uneven = Refusal(Diagram(", group: arm",
                                             "{time: 0, position: [0, 0.2]},\n"
                                             "{time: 1, position: [0, 0.2, 1]}"));
  EXPECT_THAT(uneven, HasSubstr("d.yaml:5:21: error: systems.spline: key_points[1].position: got 3 "
                                "numbers; expected 2, one a joint of 'gripper_arm': shoulder"));
  EXPECT_THAT(Refusal(Diagram(", group: arm", kTwo, "[0, 1, 2]")),
              AllOf(HasSubstr("d.yaml:5:52: error: systems.plant.initial_position: got 3 numbers; "
                              "expected 2"),
                    Not(HasSubstr("size;"))));
}

TEST_F(HeldJointsTest, NamesNeedARobot) {
  EXPECT_THAT(
      Refusal("systems: {spline: {type: LinearInterpolator, key_points: [{time: 0, position: "
              "ready}]}}\n"),
      HasSubstr("key_points[0].position: got 'ready'; expected numbers, or the key `model`"));
  const std::string two =
      "models: {a: {urdf: arm.urdf, srdf: arm.srdf}, b: {urdf: arm.urdf, srdf: arm.srdf, group: "
      "arm}}\n"
      "systems: {spline: {type: LinearInterpolator, key_points: [{time: 0, position: ready}]";
  EXPECT_THAT(Refusal(two + "}}\n"), HasSubstr("or the key `model` to say whose they are"));
  EXPECT_EQ(Goal(Load(two + ", model: b}}\n")), Eigen::Vector2d(0.3, 1.2));
  EXPECT_EQ(Goal(Load(two + ", model: a}}\n")), Eigen::Vector4d(0.3, 1.2, 0.0, 0.0));
}

}  // namespace held_joints_test
}  // namespace oca::loading
