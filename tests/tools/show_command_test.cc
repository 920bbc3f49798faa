// SPDX-License-Identifier: BSD-3-Clause
// `simulator robot show`, as a user meets it; what its page does is judged in tools/viewer/test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/program.h"

namespace oca::tools {
namespace show_command_test {

using testing::HasSubstr;
using testing::Not;

class ShowCommandTest : public testing::Test {
 protected:
  ShowCommandTest() { run.folder().Write("page.html", "<head><!--oca:source--></head>"); }
  /// Without `more`, the page goes to out.html.
  Ran Show(const std::string& robot, const std::string& more = "") const {
    const std::string folder = run.folder().path().string();
    return run("OCA_VIEWER=" + folder + "/page.html $S robot show " + robot + " " +
               (more.empty() ? "-o " + folder + "/out.html" : more));
  }
  Program run;
};

TEST_F(ShowCommandTest, WritesThePageWithTheRobotInside) {
  const Ran ran = Show("package://lwr4/lwr4.urdf");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("wrote " + (run.folder().path() / "out.html").string()));
  // The magic bytes of MCAP in base64, by hand: 89 4d 43 41 50 30 0d 0a.
  EXPECT_THAT(run.Read("out.html"), HasSubstr("id=\"oca-record\" type=\"application/octet-stream;"
                                              "base64\">iU1DQVAwDQ"));
}

TEST_F(ShowCommandTest, ServesThePageUntilItIsInterrupted) {
  const std::string folder = run.folder().path().string();
  // A command of its own, so that $! is the program and no shell.
  const Ran ran = run("true; OCA_VIEWER=" + folder +
                      "/page.html $S robot show package://planar2/planar2.urdf --port 0 > " +
                      folder + "/said & while kill -0 $! && ! grep -q http " + folder +
                      "/said; do sleep 0.1; done; kill -TERM $!; wait $!");
  EXPECT_EQ(ran.status, 130) << ran.err;
  EXPECT_THAT(run.Read("said"),
              HasSubstr("package://planar2/planar2.urdf, in a browser; Ctrl-C ends it: "
                        "http://127.0.0.1:"));
}

TEST_F(ShowCommandTest, TellsTheWarningsOfTheLoad) {
  const std::string arm = run.folder().Write("arm.urdf", R"(<robot name="arm"><link name="base">
      <visual><geometry><sphere radius="1"/></geometry></visual></link></robot>)");
  EXPECT_THAT(Show(arm).err, HasSubstr(arm + ": warning: robot 'arm' has no collision shape"));
  const Ran drawn =
      Show(arm, "--visual-as-collision missing -o " + (run.folder().path() / "o.html").string());
  EXPECT_EQ(drawn.status, 0);
  EXPECT_THAT(drawn.err, Not(HasSubstr("warning")));
}

TEST_F(ShowCommandTest, TellsAKindOfWarningOnceAndThePageEachAtItsLink) {
  std::string text = "<robot name='arm' my:note='x' xmlns:my='y'>";
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    text += std::string("<link name='") + name +
            "'><inertial><mass value='-1'/></inertial><collision><geometry><sphere radius='1'/>"
            "</geometry></collision></link>";
    if (*name == 'a') continue;
    text += std::string("<joint name='to_") + name + "' type='fixed' my:id='1'><parent link='a'/>" +
            "<child link='" + name + "'/></joint>";
  }
  const Ran ran = Show(run.folder().Write("arm.urdf", text + "</robot>"));
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("left out: of link 'a' (line 1), of link 'b' (line 1), of link "
                                 "'c' (line 1) and 2 more\n"));
  std::size_t warnings = 0;
  for (std::size_t at = 0; (at = ran.err.find("warning: ", at)) != ran.err.npos; ++at) ++warnings;
  EXPECT_EQ(warnings, 2u) << ran.err;  // of inertias and of attributes
}

TEST_F(ShowCommandTest, FindsPackagesThatLieBesideTheRobot) {
  run.folder().Write("their_arm/meshes/a.obj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string arm = run.folder().Write(
      "their_arm/urdf/arm.urdf",
      "<robot name='arm'><link name='base'><collision><geometry><mesh filename='package://"
      "their_arm/meshes/a.obj'/></geometry></collision></link></robot>");
  EXPECT_EQ(Show(arm).status, 0) << Show(arm).err;
  const Ran looked = run("$S robot check-collisions " + arm);
  EXPECT_EQ(looked.status, 0) << looked.err;
  EXPECT_THAT(looked.out, HasSubstr("arm: 0 pairs of links with solids"));
}

TEST_F(ShowCommandTest, TakesXacroAndItsArguments) {
  const std::string arm =
      run.folder().Write("arm.xacro", R"xml(<robot name="$(arg n)" xmlns:xacro="x">
      <xacro:arg name="n" default="a"/><link name="l"><visual><geometry><sphere radius="1"/>
      </geometry></visual></link></robot>)xml");
  const std::string out = " -o " + (run.folder().path() / "o.html").string();
  EXPECT_THAT(Show(arm, "--argument n=bee" + out).err, HasSubstr("robot 'bee' has no collision"));
  EXPECT_EQ(Show(arm, "--argument m=bee" + out).status, 2);
}

TEST_F(ShowCommandTest, RefusesWhatItCannotShow) {
  EXPECT_EQ(Show("missing.urdf").status, 2);
  EXPECT_EQ(Show("package://lwr4/lwr4.urdf", "--srdf package://ur5e/ur5e.srdf -o x.html").status,
            2);
  EXPECT_EQ(Show("package://lwr4/lwr4.urdf", "-o /nowhere/at/all.html").status, 2);
  EXPECT_EQ(Show("package://lwr4/lwr4.urdf", "-o ''").status, 64);
  EXPECT_EQ(Show("package://lwr4/lwr4.urdf", "--port 70000").status, 64);
  const Ran all = Show("package://lwr4/lwr4.urdf", "--visual-as-collision some -o x.html");
  EXPECT_EQ(all.status, 2);
  EXPECT_THAT(all.err, HasSubstr("expected one of: none, missing, all"));
  const Ran misspelt = Show("package://lwr4/lwr4.urdf", "--sdrf x");
  EXPECT_EQ(misspelt.status, 64);
  EXPECT_THAT(misspelt.err, HasSubstr("did you mean '--srdf'?"));
}

TEST_F(ShowCommandTest, APageThatIsThereStaysIfNoneCanBeMade) {
  run.folder().Write("out.html", "old");
  const std::string page = run.folder().Write("page_without_place.html", "<html>").string();
  EXPECT_EQ(run("OCA_VIEWER=" + page + " $S robot show package://planar2/planar2.urdf -o " +
                (run.folder().path() / "out.html").string())
                .status,
            2);
  EXPECT_EQ(run.Read("out.html"), "old");
}

TEST_F(ShowCommandTest, WritesOverNothingThatItReads) {
  const std::string urdf = (run.folder().path() / "arm.urdf").string();
  const Ran ran = run("cp models/robots/planar2/planar2.urdf " + urdf +
                      " && OCA_VIEWER=" + run.folder().path().string() +
                      "/page.html $S robot show " + urdf + " -o " + urdf);
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("is what the robot is read from"));
  EXPECT_THAT(run.Read("arm.urdf"), HasSubstr("<robot"));
}

}  // namespace show_command_test
}  // namespace oca::tools
