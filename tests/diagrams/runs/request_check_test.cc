// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/request_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace oca::runs {
namespace request_check_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kDiagrams = OCA_SOURCE_DIR "/diagrams/";

std::vector<std::string> Warnings(const std::vector<files::Override>& overrides,
                                  const std::string& file = "planar_arm.yaml") {
  return RequestWarnings(loading::LoadDiagram(kDiagrams + file, overrides));
}

TEST(RequestCheckTest, SaysNothingOfWhatCanBeDone) {
  for (const char* file : {"static_test.yaml", "dynamic_test.yaml", "ur5e_arm.yaml",
                           "planar_arm.yaml", "dual_arm.yaml", "cartesian_goal.yaml"}) {
    EXPECT_THAT(Warnings({}, file), IsEmpty()) << file;
  }
}

// Two joints, limits +-2.9 rad and 2 rad/s, from (0, 0) to (1, 0.5) between 0.5 s and 3.5 s.
class RequestCheckFile : public testing::Test {
 protected:
  RequestCheckFile() {
    folder_.Write("arm.urdf", R"(<robot name="two"><link name="base"/>
<link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.04 0.04"/></geometry></collision></link>
<link name="fore"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.04 0.04"/></geometry></collision></link>
<joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-2.9" upper="2.9" velocity="2" effort="1"/></joint>
<joint name="j2" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
<limit lower="-2.9" upper="2.9" velocity="2" effort="1"/></joint></robot>)");
    folder_.Write("d.yaml", R"(name: two
include: [package://oca/parts/avoidance.yaml]
parameters: {avoidance: safety_filter}
simulator: {duration: 4}
models: {arm: {urdf: arm.urdf}}
systems:
  obstacles:
    type: ObstacleSource
    obstacles: [{id: ball, shape: {type: sphere, radius: 0.1}, pose: {xyz: [0, 5, 0]}}]
  spline:
    type: SplineGenerator
    period: ${1 / rate}
    key_points: [{time: 0.5, position: [0, 0]}, {time: 3.5, position: [1, 0.5]}]
  plant: {initial_position: [0, 0]}
)");
  }
  std::vector<std::string> Told(const std::vector<std::string>& overrides) const {
    std::vector<files::Override> parsed;
    for (const std::string& text : overrides) parsed.push_back(files::Override::Parse(text));
    return RequestWarnings(loading::LoadDiagram(folder_.path() / "d.yaml", parsed));
  }
  test::TemporaryFolder folder_;
};

TEST_F(RequestCheckFile, SaysNothingOfTheFileItself) { EXPECT_THAT(Told({}), IsEmpty()); }

TEST_F(RequestCheckFile, AGoalBeyondALimitIsNamedWithItsPlace) {
  EXPECT_THAT(
      Told({"systems.spline.key_points.1.position=[1, 3]"}),
      ElementsAre(AllOf(HasSubstr("d.yaml:"),
                        HasSubstr("warning: systems.spline: joint 'j2' is to go to 3 rad at 3.5 s"),
                        HasSubstr("its limits are [-2.9, 2.9]"))));
}

TEST_F(RequestCheckFile, AStartBeyondALimitIsNamed) {
  EXPECT_THAT(Told({"systems.plant.initial_position=[3.5, 0]"}),
              ElementsAre(HasSubstr("systems.plant: joint 'j1' starts at 3.5 rad"),
                          HasSubstr("the request begins elsewhere")));
}

TEST_F(RequestCheckFile, ARequestThatBeginsElsewhereIsNamed) {
  EXPECT_THAT(Told({"systems.plant.initial_position=[0, 0.01]"}),
              ElementsAre(HasSubstr("systems.spline: the request begins elsewhere than the arm: "
                                    "joint 'j2' at 0 rad, where it stands at 0.01")));
  EXPECT_THAT(Told({"systems.plant.initial_position=[0.01, 0.01]"}),
              ElementsAre(HasSubstr("; and 1 more joint likewise")));
  EXPECT_THAT(Told({"systems.plant.initial_position=[0, 0.0009]"}), IsEmpty());
}

TEST_F(RequestCheckFile, ARequestThatEndsAfterTheRunIsNamed) {
  EXPECT_THAT(Told({"simulator.duration=1"}),
              ElementsAre(HasSubstr("systems.spline: the request ends at 3.5 s, after the run, "
                                    "which ends at 1 s")));
  EXPECT_THAT(Told({"simulator.duration=3.5"}), IsEmpty());
}

// The same arm with two fingers, one of which mimics the other.
class GripperCheckFile : public RequestCheckFile {
 protected:
  GripperCheckFile() {
    const std::string finger =
        "<parent link='fore'/><origin xyz='0.5 0 0'/><axis xyz='0 1 0'/><limit lower='0' "
        "upper='0.04' velocity='0.2' effort='1'/>";
    std::ifstream in(folder_.path() / "arm.urdf");
    std::string urdf(std::istreambuf_iterator<char>(in), {});
    urdf.replace(urdf.find("</robot>"), 8,
                 "<link name='left'/><link name='right'/><joint name='l' type='prismatic'><child "
                 "link='left'/>" +
                     finger + "</joint><joint name='r' type='prismatic'><child link='right'/>" +
                     finger + "<mimic joint='l'/></joint></robot>");
    folder_.Write("arm.urdf", urdf);
  }
  std::vector<std::string> OfFingers(const std::string& goal) const {
    return Told(
        {"systems.spline.key_points=[{time: 0.5, position: [0, 0, 0.02]}, {time: 3.5, position: "
         "[1, "
         "0, " +
             goal + "]}]",
         "systems.plant.initial_position=[0, 0, 0.02]"});
  }
};

TEST_F(GripperCheckFile, FingersThatAreAskedToStayAreNamedSinceWhatEvadesMovesThem) {
  EXPECT_THAT(
      OfFingers("0.02"),
      ElementsAre(AllOf(HasSubstr("systems.spline: what evades moves joints of model 'arm'"),
                        HasSubstr("`held: {l: 0.02}`"))));
}

TEST_F(GripperCheckFile, FingersThatTheTaskMovesOrTheModelHoldsAreNot) {
  EXPECT_THAT(OfFingers("0.03"), IsEmpty());
  EXPECT_THAT(Told({"models.arm.held={l: 0.02}"}), IsEmpty());
}

TEST_F(RequestCheckFile, ARequestTooFastIsNamedWithItsSpeed) {
  // A cubic from rest to rest: 1.5 times the mean speed, in the middle: 1.5 / 0.5 s.
  EXPECT_THAT(Told({"systems.spline.key_points.1.time=1"}),
              testing::Contains(AllOf(HasSubstr("joint 'j1' is to move at 3 rad/s at 0.75 s"),
                                      HasSubstr("its limit is 2"))));
}

TEST_F(RequestCheckFile, AccelerationsAreLookedAtWhereTheyHaveALimit) {
  // The same motion accelerates with 6 way / time^2 = 6 / 2.25 rad/s^2 at its ends.
  EXPECT_THAT(
      Told({"systems.spline.key_points.1.time=2", "parameters.acceleration_limit=1.3"}),
      ElementsAre(AllOf(HasSubstr("joint 'j1' is to accelerate with"), HasSubstr("2.667 rad/s^2"),
                        HasSubstr("and 1 more joint likewise"))));
}

TEST_F(RequestCheckFile, ContactAtTheStartAndAtTheEndIsNamed) {
  EXPECT_THAT(Told({"systems.obstacles.obstacles.0.pose.xyz=[0.8, 0.05, 0]"}),
              ElementsAre(AllOf(HasSubstr("systems.plant: the arm starts in contact: fore is"),
                                HasSubstr("deep in ball at 0 s"))));
  EXPECT_THAT(Told({"systems.obstacles.obstacles.0.pose.xyz=[0.27, 0.42, 0]"}),
              ElementsAre(HasSubstr("systems.spline: the request ends in contact: upper is")));
}

TEST_F(RequestCheckFile, AWallThatNoWayPassesIsToldAndAPostIsNot) {
  // From near the foot to beyond the reach, between start and goal.
  const std::string wall =
      "systems.obstacles.obstacles=[{id: wall, shape: {type: box, size: [LENGTH, 0.04, 0.4]}, "
      "pose: {xyz: [0.614, 0.336, 0], rpy: [0, 0, 0.5]}}]";
  const auto told = [&](const std::string& length) {
    std::string text = wall;
    return Told({text.replace(text.find("LENGTH"), 6, length)});
  };
  EXPECT_THAT(told("1.2"),
              ElementsAre(AllOf(HasSubstr("systems.spline: no way to the end of the request was "
                                          "found among what stands"),
                                HasSubstr("(2-norm of the joints); there "), HasSubstr("wall"))));
  EXPECT_THAT(told("0.1"), IsEmpty()) << "the arm folds and passes within";
}

}  // namespace request_check_test
}  // namespace oca::runs
