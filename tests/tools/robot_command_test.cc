// SPDX-License-Identifier: BSD-3-Clause
// `simulator robot check-collisions`, as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace oca::tools {
namespace robot_command_test {

using nlohmann::json;
using testing::HasSubstr;

class RobotCommandTest : public testing::Test {
 protected:
  std::string Out() const { return (run.folder().path() / "new.srdf").string(); }
  const std::string check_{"$S robot check-collisions package://lwr4/lwr4.urdf --samples 2000 "};
  Program run;
};

TEST_F(RobotCommandTest, PrintsEveryPairOfLinksWithItsKind) {
  const Ran ran = run(check_);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("lwr4: 28 pairs of links with solids, 2000 samples, seed 0"));
  EXPECT_THAT(ran.out, HasSubstr("to check: 5; not: 7 adjacent, 1 always, 15 never in collision"));
}

TEST_F(RobotCommandTest, WritesAnSrdfThatADiagramMayUseAndNothingUnasked) {
  EXPECT_EQ(run(check_).status, 0);
  EXPECT_FALSE(std::filesystem::exists(Out()));
  const Ran ran = run(check_ + "--write-srdf " + Out());
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("wrote " + Out()));
  EXPECT_EQ(run("$S run diagrams/static_test.yaml -t 0.1 -s models.arm.srdf=" + Out() +
                " -s expect.final_error.at_most=9")
                .status,
            0);
  // The same again: what is written depends on the model, the seed and the samples alone.
  const std::string text = run.Read("new.srdf");
  EXPECT_EQ(run(check_ + "--write-srdf " + Out()).status, 0);
  EXPECT_EQ(run.Read("new.srdf"), text);
  EXPECT_THAT(text, HasSubstr("reason=\"Always\""));
}

// Fewer samples than the files were made with: these find the same pairs.
TEST_F(RobotCommandTest, LeavesEverySrdfOfTheProductAsItIs) {
  namespace fs = std::filesystem;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(OCA_SOURCE_DIR "/models/robots")) {
    if (entry.path().extension() != ".srdf") continue;
    ++files;
    const fs::path copy = run.folder().path() / entry.path().filename();
    fs::copy_file(entry.path(), copy);
    const std::string text = run.Read(copy.filename());
    const std::string urdf = fs::path(entry.path()).replace_extension(".urdf").string();
    const Ran ran =
        run("$S robot check-collisions " + urdf + " --samples 10000 --write-srdf " + copy.string());
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(run.Read(copy.filename()), text) << entry.path() << "\n" << ran.out;
    EXPECT_THAT(text, HasSubstr("check-collisions package://"));
  }
  EXPECT_GE(files, 7);
}

TEST_F(RobotCommandTest, JsonHoldsAllPairs) {
  const Ran ran = run(check_ + "--json --seed 5 --margin 0.5");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json result = json::parse(ran.out);
  EXPECT_EQ(result["robot"], "lwr4");
  EXPECT_EQ(result["seed"], 5);
  ASSERT_EQ(result["pairs"].size(), 28u);
  const json& pair = result["pairs"][1];
  EXPECT_EQ(pair["link1"], "lwr4_base_link");
  EXPECT_EQ(pair["link2"], "lwr4_link_2");
  EXPECT_EQ(pair["kind"], "Sometimes") << "with a margin that nothing keeps";
  EXPECT_GT(pair["least_distance"].get<double>(), 0.05);
}

TEST_F(RobotCommandTest, RefusesWhatItCannotDo) {
  EXPECT_EQ(run("$S robot check-collisions package://lwr4/lwr4.urdf --samples 0").status, 2);
  for (const char* words : {"--seed -1", "--samples 1000000000", "--samples 1e3"}) {
    const Ran refused =
        run(std::string("$S robot check-collisions package://lwr4/lwr4.urdf ") + words);
    EXPECT_EQ(refused.status, 64) << words;
    EXPECT_THAT(refused.err, HasSubstr("expected a whole number")) << words;
  }
  EXPECT_EQ(run(check_ + "--margin -1").status, 2);
  EXPECT_EQ(run("$S robot check-collisions missing.urdf").status, 2);
  EXPECT_EQ(run(check_ + "--write-srdf /nowhere/at/all.srdf").status, 2);
  const Ran over = run("cp models/robots/planar2/planar2.urdf " + Out() +
                       " && $S robot check-collisions " + Out() + " --write-srdf " + Out());
  EXPECT_EQ(over.status, 2);
  EXPECT_THAT(over.err, HasSubstr("is what the robot is read from"));
  EXPECT_EQ(run("$S robot").status, 64);
  const Ran unknown = run("$S robot check-colisions x");
  EXPECT_EQ(unknown.status, 64);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'check-collisions'?"));
  const Ran misspelt = run(check_ + "--sampels 5");
  EXPECT_EQ(misspelt.status, 64);
  EXPECT_THAT(misspelt.err, HasSubstr("did you mean '--samples'?"));
}

TEST_F(RobotCommandTest, ExpandsXacroAndTakesItsArguments) {
  const std::string arm = run.folder()
                              .Write("arm.xacro", R"xml(
<robot name="$(arg n)" xmlns:xacro="x">
  <xacro:arg name="n" default="a"/>
  <xacro:arg name="r" default="0.1"/>
  <xacro:macro name="ball" params="link">
    <link name="${link}"><collision>
      <geometry><sphere radius="${2 * $(arg r)}"/></geometry>
    </collision></link>
  </xacro:macro>
  <xacro:ball link="base"/>
  <xacro:ball link="tip"/>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>)xml")
                              .string();
  const Ran printed = run("$S robot expand " + arm + " --argument n=b --argument r=0.25");
  EXPECT_EQ(printed.status, 0) << printed.err;
  EXPECT_THAT(printed.out, HasSubstr("<robot name=\"b\">"));
  EXPECT_THAT(printed.out, HasSubstr("<sphere radius=\"0.5\"/>"));
  const std::string out = (run.folder().path() / "arm.urdf").string();
  EXPECT_EQ(run("$S robot expand " + arm + " -o " + out).status, 0);
  EXPECT_THAT(run.Read("arm.urdf"), HasSubstr("<robot name=\"a\">"));
  EXPECT_EQ(run("$S robot check-collisions " + out).status, 0);
  const Ran checked = run("$S robot check-collisions " + arm + " --argument n=c");
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("c: 1 pairs"));
  const Ran over = run("$S robot expand " + arm + " -o " + arm);
  EXPECT_EQ(over.status, 2);
  EXPECT_THAT(over.err, HasSubstr("is what is expanded"));
  const Ran unknown = run("$S robot expand " + arm + " --argument m=1");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("unknown argument; got 'm'"));
  EXPECT_EQ(run("$S robot expand " + arm + " --argument m").status, 2);
  EXPECT_EQ(run("$S robot expand " + arm + " --argument n=1 --argument n=2").status, 2);
  EXPECT_EQ(run("$S robot expand missing.xacro").status, 2);
}

TEST_F(RobotCommandTest, PackagesNearTheRobotAreKnownToEveryCommand) {
  run.folder().Write("ws/their_arm/inc/links.xacro",
                     R"(<robot xmlns:xacro="x"><xacro:macro name="base"><link name="base">
<collision><geometry><sphere radius="0.1"/></geometry></collision></link></xacro:macro></robot>)");
  const std::string arm = run.folder().Write("ws/their_arm/urdf/arm.urdf.xacro",
                                             R"xml(<robot name="arm" xmlns:xacro="x"><xacro:include
filename="$(find their_arm)/inc/links.xacro"/><xacro:base/><link name="tip"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/>
<origin xyz="0.25 0 0"/></joint></robot>)xml");
  const Ran expanded = run("$S robot expand " + arm);
  EXPECT_EQ(expanded.status, 0) << expanded.err;
  EXPECT_THAT(expanded.out, HasSubstr("<link name=\"base\">"));
  const Ran evaluated = run("$S eval RobotKinematics --model arm=" + arm, "{\"position\":[0]}\n");
  EXPECT_EQ(evaluated.status, 0) << evaluated.err;
  EXPECT_THAT(evaluated.out, HasSubstr("[0.25,0.0,0.0]"));
  const Ran looked = run("$S robot check-collisions " + arm);
  EXPECT_EQ(looked.status, 0) << looked.err;
}

TEST_F(RobotCommandTest, APackageThatIsNowhereIsToldWithTheWayToNameIt) {
  const std::string arm = run.folder().Write(
      "arm.xacro",
      R"xml(<robot name="arm" xmlns:xacro="x"><link name="$(find no_such_arm)"/></robot>)xml");
  for (const std::string& command :
       {"robot expand " + arm, "robot show -o x.html " + arm, "robot check-collisions " + arm,
        "eval RobotKinematics --model arm=" + arm}) {
    const Ran ran = run("$S " + command);
    EXPECT_EQ(ran.status, 2) << command;
    EXPECT_THAT(ran.err, testing::AllOf(HasSubstr("'no_such_arm'"), HasSubstr("OCA_PACKAGE_PATH="),
                                        HasSubstr("arm.xacro:1")));
  }
}

}  // namespace robot_command_test
}  // namespace oca::tools
