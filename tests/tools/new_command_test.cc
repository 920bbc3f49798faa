// SPDX-License-Identifier: BSD-3-Clause
// `simulator new`, as a user meets it; what it drafts is judged in tests/diagrams/drafts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/program.h"

namespace oca::tools {
namespace new_command_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class NewCommandTest : public testing::Test {
 protected:
  NewCommandTest() { run.folder().Write("page.html", "<head><!--oca:source--></head>"); }
  Ran New(const std::string& arguments, const std::string& page = "page.html") const {
    const std::string folder = run.folder().path().string();
    return run("cd " + folder + "; OCA_VIEWER=" + folder + "/" + page + " $S new " + arguments);
  }
  Program run;
};

TEST_F(NewCommandTest, LeadsFromARobotToAReportOfARunThatIsClear) {
  const Ran ran = New("package://ur5e/ur5e.urdf");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("robot 'ur5e': 6 joints"), HasSubstr("wrote ur5e/ur5e.yaml"),
                    HasSubstr("without avoidance: CONTACT of "), HasSubstr("  clearance    clear"),
                    HasSubstr("report: ur5e/ur5e.html")));
  EXPECT_THAT(run.Read("ur5e/ur5e.html"), HasSubstr("id=\"oca-record\""));
  EXPECT_THAT(run.Read("ur5e/ur5e.yaml"), HasSubstr("urdf: \"package://ur5e/ur5e.urdf\""));
  EXPECT_EQ(run("cd " + run.folder().path().string() + "; $S run ur5e/ur5e.yaml").status, 0);
}

TEST_F(NewCommandTest, TellsOfSlidersInMetres) {
  const auto slide = [](const std::string& from, const std::string& to, const std::string& axis) {
    return "<link name='" + to +
           "'><collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision></link>"
           "<joint name='to_" +
           to + "' type='prismatic'><parent link='" + from + "'/><child link='" + to +
           "'/><axis xyz='" + axis +
           "'/><limit lower='0' upper='1' velocity='1' effort='1'/></joint>";
  };
  run.folder().Write("table.urdf", "<robot name='table'><link name='base'/>" +
                                       slide("base", "x", "1 0 0") + slide("x", "y", "0 1 0") +
                                       slide("y", "z", "0 0 1") + "</robot>");
  const Ran ran = New("table.urdf");
  EXPECT_THAT(ran.out, AllOf(HasSubstr(" m off"), HasSubstr(" m, path "), HasSubstr(" m/s, "),
                             HasSubstr(" m/s^2\n"), Not(HasSubstr("rad"))))
      << ran.err;
}

TEST_F(NewCommandTest, ReplacesNothing) {
  for (const std::string name : {"ur5e.yaml", "ur5e.srdf", "ur5e.html"}) {
    const std::string folder = "has_" + name;
    run.folder().Write(folder + "/" + name, "precious");
    const Ran ran = New("package://ur5e/ur5e.urdf -o " + folder);
    EXPECT_EQ(ran.status, 2) << name;
    EXPECT_THAT(ran.err, HasSubstr(folder + "/" + name + " is there already"));
    EXPECT_EQ(run.Read(folder + "/" + name), "precious");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(run.folder().path() / folder), {}),
              1)
        << name;
  }
}

TEST_F(NewCommandTest, LeavesNothingHalfWhenItIsInterrupted) {
  int interrupted = 0;
  for (const char* wait : {"0.05", "0.1", "0.2", "0.5"}) {
    const Ran ran = New("package://iiwa14/iiwa14.urdf -o it & sleep " + std::string(wait) +
                        "; kill -INT $!; wait $!");
    if (ran.status == 0) {  // it was done before, or did not listen yet
      std::filesystem::remove_all(run.folder().path() / "it");
      continue;
    }
    ++interrupted;
    EXPECT_EQ(ran.status, 130) << wait << ran.err;
    // Once it has told of its files they are whole.
    const bool told = ran.out.find("wrote it/") != std::string::npos;
    EXPECT_EQ(std::filesystem::exists(run.folder().path() / "it"), told) << wait;
    std::filesystem::remove_all(run.folder().path() / "it");
  }
  EXPECT_GE(interrupted, 1);
}

TEST_F(NewCommandTest, RefusesWhatIsNoRobotAndLeavesNothing) {
  run.folder().Write("one.urdf", "<robot name='one'><link name='a'/></robot>");
  const Ran ran = New("one.urdf");
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("robot 'one': its arm; got 0 joints"));
  EXPECT_FALSE(std::filesystem::exists(run.folder().path() / "one"));
}

}  // namespace new_command_test
}  // namespace oca::tools
