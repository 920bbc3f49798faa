// SPDX-License-Identifier: BSD-3-Clause
// `simulator import` and `simulator scenes`, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/program.h"

namespace oca::tools {
namespace import_command_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const char* const kRobot = " --robot package://ur5e/ur5e.urdf --srdf package://ur5e/ur5e.srdf -o ";

class ImportCommandTest : public testing::Test {
 protected:
  Ran Import(const std::string& files, const std::string& output = "shelf.yaml") const {
    return run("$S import " + files + kRobot + Path(output));
  }
  std::string Path(const std::string& name) const { return (run.folder().path() / name).string(); }
  /// A request of the UR5e with one line of another.
  std::string RequestWith(const std::string& from, const std::string& to) const {
    const Ran ran = run("sed 's|" + from + "|" + to + "|' models/worlds/shelf/request.yaml");
    return run.folder().Write("request.yaml", ran.out).string();
  }
  const std::string shelf_{"models/worlds/shelf/scene.yaml models/worlds/shelf/request.yaml"};
  Program run;
};

TEST_F(ImportCommandTest, MakesADiagramThatChecksWithoutAWordAndRuns) {
  const Ran ran = Import(shelf_);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("robot 'ur5e': 6 joints; 3 obstacles, 1 held objects"),
                             HasSubstr("decided:  limits of acceleration: 10 rad/s^2"),
                             HasSubstr("left out: models/worlds/shelf/request.yaml:14: "
                                       "workspace_parameters: not looked at")));
  EXPECT_THAT(run.Read("shelf.yaml"),
              AllOf(HasSubstr("type: compound"), HasSubstr("urdf: \"package://ur5e/ur5e.urdf\""),
                    HasSubstr("- [gripper, can]"), HasSubstr("{time: 6, position: [2.6, "),
                    HasSubstr("xyz: [0.3, 0.7, 0.135]")));
  const Ran check = run("$S check " + Path("shelf.yaml"));
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_EQ(check.err, "");
  const Ran report = run("$S run " + Path("shelf.yaml") + " -t 12 --json --profile");
  EXPECT_EQ(report.status, 0) << report.err;
  EXPECT_THAT(report.out, AllOf(HasSubstr("\"path_length\""), HasSubstr("\"final_speed\""),
                                HasSubstr("\"times\"")));
}

TEST_F(ImportCommandTest, ReadsTheTextFormatAndASceneWithoutARequest) {
  const Ran ran = Import("models/worlds/shelf/shelf.scene");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("no state of the joints"));
  EXPECT_EQ(run("$S check " + Path("shelf.yaml")).status, 0);
}

TEST_F(ImportCommandTest, ReplacesNothing) {
  run.folder().Write("shelf.yaml", "mine");
  const Ran ran = Import(shelf_);
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("shelf.yaml is there already"));
  EXPECT_EQ(run.Read("shelf.yaml"), "mine");
}

TEST_F(ImportCommandTest, AJointOfTheArmThatIsMissingIsRefusedWithItsPlace) {
  const Ran ran = Import("models/worlds/shelf/scene.yaml " +
                         RequestWith("joint_name: ur5e_joint_4", "joint_name: elbow"));
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err,
              HasSubstr("request.yaml:7: goal_constraints[0]: joint 'ur5e_joint_4'; got none"));
  EXPECT_EQ(run.Read("shelf.yaml"), "");
}

TEST_F(ImportCommandTest, AnUnknownFrameIsRefusedWithItsPlace) {
  const Ran text =
      run("sed 's|frame_id: shelf/board|frame_id: shelf/bord|' "
          "models/worlds/shelf/scene.yaml");
  const auto scene = run.folder().Write("scene.yaml", text.out);
  const Ran ran = Import(scene.string());
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("scene.yaml:35: frame; got 'shelf/bord'"),
                             HasSubstr("did you mean 'shelf/board'?")));
}

TEST_F(ImportCommandTest, AGoalOfAPoseIsFoundWhenTheFileIsLoaded) {
  const auto request = run.folder().Write("request.yaml", R"(
goal_constraints:
  - position_constraints:
      - link_name: ur5e_flange
        constraint_region:
          primitives: [{type: sphere, dimensions: [0.001]}]
          primitive_poses: [{position: [-0.3, 0.4, 0.3], orientation: [0, 0, 0, 1]}]
    orientation_constraints:
      - {link_name: ur5e_flange, orientation: [1, 0, 0, 0]}
)");
  EXPECT_EQ(Import("models/worlds/shelf/scene.yaml " + request.string()).status, 0);
  EXPECT_THAT(run.Read("shelf.yaml"),
              AllOf(HasSubstr("pose: {xyz: [-0.3, 0.4, 0.3], quaternion: ["),
                    HasSubstr("link: ur5e_flange")));
  EXPECT_EQ(run("$S check " + Path("shelf.yaml")).status, 0);
}

TEST_F(ImportCommandTest, MakesTheSameScenesOfASeed) {
  const auto make = [&](const std::string& folder) {
    return run(
        "$S scenes package://ur5e/ur5e.urdf --srdf package://ur5e/ur5e.srdf --family cage "
        "--samples 2 --seed 5 -o " +
        Path(folder));
  };
  EXPECT_EQ(make("one").status, 0);
  EXPECT_THAT(make("two").out, HasSubstr("cage: 2 problems of "));
  EXPECT_EQ(run("diff -r " + Path("one") + " " + Path("two")).out, "");
  EXPECT_THAT(run.Read("one/cage/scene0002.yaml"), HasSubstr("id: cube_1"));
  EXPECT_NE(run.Read("one/cage/scene0001.yaml"), run.Read("one/cage/scene0002.yaml"));
  EXPECT_EQ(make("one").status, 2);  // they are there
}

TEST_F(ImportCommandTest, AFolderOfScenesIsRunAndGoesOnWhereItStopped) {
  if (run("node --version").status != 0) GTEST_SKIP() << "no Node";
  run("$S scenes package://ur5e/ur5e.urdf --srdf package://ur5e/ur5e.srdf --family cage --samples "
      "2 "
      "-o " +
      Path("made"));
  const std::string words =
      "SIMULATOR=$S tools/benchmark_scenes.sh --no-plan --samples 1 "
      "--duration 0.5 -o " +
      Path("results") + " ";
  const std::string robot = " models/robots/ur5e/ur5e.urdf";
  const Ran ran = run(words + Path("made") + robot);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("closed loop"), HasSubstr("cage"), HasSubstr("0/1 [")));
  EXPECT_THAT(ran.err, HasSubstr("1/1 cage 0001"));
  const Ran again = run(words + Path("made") + robot);
  EXPECT_EQ(again.out, ran.out);
  EXPECT_THAT(again.err, Not(HasSubstr("1/1")));
  EXPECT_EQ(run(words + "--set parameters.avoid=false " + Path("made") + robot).status, 64);
  EXPECT_EQ(run(words + Path("results/cage") + robot).status, 2);  // no pairs
}

}  // namespace import_command_test
}  // namespace oca::tools
