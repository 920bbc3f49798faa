// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/srdf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace srdf_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::ThrowsMessage;

const SrdfRobot kRobot{"r", {"base", "arm", "hand"}, {"turn", "grip"}};

std::vector<std::pair<int, int>> Load(const std::string& content) {
  const oca::test::TemporaryFolder folder;
  return LoadSrdf(folder.Write("pairs.srdf", content).string(), kRobot).disabled_pairs;
}

std::string RefusalOf(const std::string& content) {
  try {
    Load(content);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

/// Of a robot `r` with these elements, which begin in line 2.
std::string RefusalOfElements(const std::string& elements) {
  return RefusalOf("<robot name='r'>\n" + elements + "\n</robot>");
}

TEST(SrdfTest, DisabledPairsAreFoundInAnyOrder) {
  EXPECT_THAT(Load(R"(<robot name="r"><group name="g"/>
                        <disable_collisions link1="hand" link2="arm" reason="Adjacent"/>
                        <disable_collisions link1="base" link2="arm"/></robot>)"),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
  EXPECT_THAT(Load("<robot/>"), IsEmpty());
}

TEST(SrdfTest, DefaultsAreOverruledByNamedPairs) {
  EXPECT_THAT(Load(R"(<robot><enable_collisions link1="hand" link2="base"/>
                        <disable_default_collisions link="hand"/></robot>)"),
              ElementsAre(Pair(1, 2)));
}

TEST(SrdfTest, UnknownLinkIsRefusedWithItsLineAndTheNearestName) {
  EXPECT_THAT([] { Load("<robot>\n<disable_collisions link1='base' link2='amr'/></robot>"); },
              ThrowsMessage<models::ModelError>(
                  AllOf(HasSubstr("srdf:2:"), HasSubstr("'amr'"), HasSubstr("'arm'"))));
  EXPECT_THAT([] { Load("<robot><disable_collisions link1='base'/></robot>"); },
              ThrowsMessage<models::ModelError>(HasSubstr("link2")));
}

TEST(SrdfTest, AllElementsOfMoveItAreAccepted) {
  EXPECT_EQ(RefusalOf(R"(<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- everything -->
  <group name="all"><group name="arm"/><joint name="grip"/><link name="hand"/></group>
  <group name="arm"><chain base_link="base" tip_link="hand"/><joint name="world_joint"/></group>
  <group_state name="home" group="arm"><joint name="turn" value="0.5"/>
    <joint name="world_joint" value="0 0 0"/></group_state>
  <end_effector name="gripper" parent_link="hand" group="arm" parent_group="all"/>
  <virtual_joint name="world_joint" type="planar" parent_frame="odom" child_link="base"/>
  <passive_joint name="grip"/>
  <group name="passive"><passive_joint name="grip"/></group>
  <joint_property joint_name="turn" property_name="angular_distance_weight" value="0.1"/>
  <link_sphere_approximation link="arm"><sphere center="0 0 0.1" radius="0"/></link_sphere_approximation>
  <disable_default_collisions link="arm"/>
  <enable_collisions link1="arm" link2="base"/>
  <disable_collisions link1=" arm " link2="hand" reason="Adjacent"/>
</robot>)"),
            "accepted");
}

TEST(SrdfTest, MisspeltElementsAndAttributesAreRefusedWithTheNearestName) {
  EXPECT_THAT(RefusalOfElements("<enable_collision link1='arm' link2='base'/>"),
              AllOf(HasSubstr("pairs.srdf:2: <enable_collision>: unknown element"),
                    HasSubstr("nearest is 'enable_collisions'")));
  EXPECT_THAT(RefusalOfElements("<disable_collisions link1='arm' link_2='base'/>"),
              AllOf(HasSubstr("unknown attribute; got 'link_2'"), HasSubstr("nearest is 'link2'")));
  EXPECT_THAT(RefusalOfElements("<disable_default_collisions name='arm'/>"),
              HasSubstr("unknown attribute; got 'name'"));
  EXPECT_THAT(RefusalOfElements("<group name='g'><links name='arm'/></group>"),
              HasSubstr("unknown element in <group>; got 'links'"));
  EXPECT_THAT(
      RefusalOfElements("<group name='g'><disable_collisions link1='arm' link2='base'/></group>"),
      HasSubstr("unknown element in <group>"));
  EXPECT_THAT(RefusalOfElements("disable_collisions link1='arm' link2='base'/>"),
              HasSubstr("text; got 'disable_collisions"));
  EXPECT_THAT(RefusalOf("<robot nam='r'/>"), HasSubstr("unknown attribute; got 'nam'"));
}

TEST(SrdfTest, WhatElementsNameMustBeThere) {
  for (const auto& [element, got] : {
           std::pair("<group name='g'><link name='arn'/></group>", "unknown link; got 'arn'"),
           std::pair("<group name='g'><joint name='tur'/></group>", "unknown joint; got 'tur'"),
           std::pair("<group name='g'><group name='h'/></group>", "unknown group; got 'h'"),
           std::pair("<group name='g'><chain base_link='base' tip_link='tip'/></group>",
                     "unknown link; got 'tip'"),
           std::pair("<group_state name='s' group='g'/>", "a group, of which there is none"),
           std::pair("<group name='g'/><group_state name='s' group='g'><joint name='turn' "
                     "value='1 x'/></group_state>",
                     "value; got '1 x'"),
           std::pair("<group name='g'/><end_effector name='e' parent_link='h' group='g'/>",
                     "unknown link; got 'h'"),
           std::pair("<virtual_joint name='v' type='ball' parent_frame='w' child_link='base'/>",
                     "got 'ball'"),
           std::pair("<passive_joint name='x'/>", "unknown joint; got 'x'"),
           std::pair("<joint_property joint_name='x' property_name='p' value='1'/>",
                     "unknown joint; got 'x'"),
           std::pair("<link_sphere_approximation link='arm'><sphere center='0 0' radius='1'/>"
                     "</link_sphere_approximation>",
                     "center; got '0 0'"),
           std::pair("<disable_default_collisions link='x'/>", "unknown link; got 'x'"),
           std::pair("<enable_collisions link1='arm' link2='x'/>", "unknown link; got 'x'"),
           std::pair("<disable_collisions link1='arm'/>", "link2; got nothing"),
       }) {
    EXPECT_THAT(RefusalOfElements(element), AllOf(HasSubstr("pairs.srdf:2:"), HasSubstr(got)))
        << element;
  }
}

/// A group g0 with g1 in it, g1 with g2, and so on, `count` groups in all.
std::string GroupsInEachOther(int count) {
  std::string elements;
  for (int i = 0; i + 1 < count; ++i) {
    elements += fmt::format("<group name='g{}'><group name='g{}'/></group>", i, i + 1);
  }
  return elements + fmt::format("<group name='g{}'><joint name='turn'/></group>", count - 1);
}

TEST(SrdfTest, GroupsInEachOtherAreBounded) {
  EXPECT_EQ(RefusalOfElements(GroupsInEachOther(64)), "accepted");
  EXPECT_THAT(RefusalOfElements(GroupsInEachOther(65)),
              HasSubstr("pairs.srdf:2: <group>: nesting; got more than 64 groups in each other"));
  EXPECT_THAT(RefusalOfElements(GroupsInEachOther(20000)), HasSubstr("more than 64 groups"));
}

TEST(SrdfTest, ASecondGroupOfANameIsRefusedWithTheLineOfTheFirst) {
  EXPECT_THAT(RefusalOfElements("<group name='a'/>\n\n<group name=' a'/>"),
              HasSubstr("pairs.srdf:4: <group>: name; got a second group 'a', the first is in line "
                        "2; expected one group of a name"));
}

TEST(SrdfTest, NamesWithALineBreakAreRefusedInOneLine) {
  for (const char* const element :
       {"<group name='x&#10;y'/>", "<group name='x&#xd;y'/>", "<group name='x\ny'/>",
        "<group name='g'><link name='x&#10;y'/></group>",
        "<disable_collisions link1='x&#10;y' link2='arm'/>"}) {
    const std::string refusal = RefusalOfElements(element);
    EXPECT_THAT(refusal, HasSubstr("got 'x y', with a line break; expected a name in one line"));
    EXPECT_EQ(refusal.find_first_of("\r\n"), refusal.npos) << element;
  }
  EXPECT_EQ(RefusalOfElements("<group name='\n  g\n'/>"), "accepted");  // around it, as MoveIt
}

/// Of a chain base - arm - hand whose joints turn within [-1, 2] and without end.
std::vector<std::string> WarningsOf(const std::string& elements) {
  SrdfRobot robot = kRobot;
  robot.parents = {-1, 0, 1};
  robot.limits = {{-1.0, 2.0}, {-kUnlimited, kUnlimited}};
  const oca::test::TemporaryFolder folder;
  return LoadSrdf(folder.Write("w.srdf", "<robot name='r'>\n" + elements + "</robot>"), robot)
      .warnings;
}

TEST(SrdfTest, GroupsInACircleAreTold) {
  EXPECT_THAT(
      WarningsOf(
          "<group name='a'><group name='b'/></group>\n"
          "<group name='b'><joint name='turn'/><group name='c'/></group>\n"
          "<group name='c'><group name='b'/></group><group name='d'><group name='d'/></group>"),
      ElementsAre(
          EndsWith("w.srdf:3: <group>: nesting; got 'b' in 'c' in 'b'; expected groups that "
                   "are not in themselves; none of these can be used; and 1 more")));
  EXPECT_THAT(WarningsOf("<group name='a'><group name='a'/></group>"),
              ElementsAre(HasSubstr("got 'a' in 'a'")));
  // The same group by two ways is no circle.
  EXPECT_THAT(WarningsOf("<group name='a'><group name='b'/><group name='c'/></group>"
                         "<group name='b'><group name='c'/></group>"
                         "<group name='c'><joint name='turn'/></group>"),
              IsEmpty());
}

TEST(SrdfTest, ChainsFromTipToBaseAndOfOneLinkAreTold) {
  EXPECT_THAT(WarningsOf("<group name='g'><chain base_link='base' tip_link='hand'/></group>"),
              IsEmpty());
  EXPECT_THAT(
      WarningsOf("<group name='g'><chain base_link='hand' tip_link='base'/></group>"),
      ElementsAre(EndsWith("w.srdf:2: <chain>: base_link; got 'hand', which lies beyond the "
                           "tip_link 'base'; expected the link nearer to the root; the joints "
                           "between are taken")));
  EXPECT_THAT(WarningsOf("<group name='g'><chain base_link='arm' tip_link='arm'/></group>"),
              ElementsAre(HasSubstr("tip_link; got 'arm', the base_link too")));
}

TEST(SrdfTest, APairOfALinkWithItselfIsToldAndIsNone) {
  const std::string twice = "<disable_collisions link1='arm' link2='arm'/>";
  EXPECT_THAT(WarningsOf(twice), ElementsAre(HasSubstr("link2; got 'arm', the link1 too")));
  EXPECT_THAT(Load("<robot name='r'>" + twice + "</robot>"), IsEmpty());
}

TEST(SrdfTest, StatesBeyondLimitsAreToldOnceAndCounted) {
  const auto state = [](const char* joint, const char* value) {
    return fmt::format(
        "<group_state name='s' group='g'><joint name='{}' value='{}'/></group_state>", joint,
        value);
  };
  const std::string group = "<group name='g'/>";
  // The assistant rounds 2 - 3e-5 and the like to four decimals.
  EXPECT_THAT(WarningsOf(group + state("turn", "2.00004") + state("grip", "900")), IsEmpty());
  EXPECT_THAT(
      WarningsOf(group + state("turn", "2.0001")),
      ElementsAre(HasSubstr(
          "w.srdf:2: joint 'turn' <joint>: value; got 2.0001; expected -1 to 2, its limits")));
  EXPECT_THAT(WarningsOf(group + state("grip", "1e9") + state("turn", "-1.1")),
              ElementsAre(AllOf(
                  HasSubstr("joint 'grip' <joint>: value; got 1e+09; expected -1e+06 to 1e+06"),
                  EndsWith("; and 1 more"))));
}

TEST(SrdfTest, AnotherRobotsFileAndXacroAreRefused) {
  EXPECT_THAT(RefusalOf("<robot name='s'/>"),
              HasSubstr("pairs.srdf:1: <robot>: name; got 's'; expected 'r', the URDF's robot"));
  EXPECT_THAT(RefusalOfElements("<xacro:arm prefix='a'/>"), HasSubstr("run xacro first"));
  EXPECT_THAT(RefusalOfElements("<disable_collisions link1='${p}arm' link2='base'/>"),
              HasSubstr("run xacro first"));
}

TEST(SrdfTest, OtherFilesAreRefused) {
  EXPECT_THROW(Load(""), models::ModelError);
  EXPECT_THROW(Load("<urdf/>"), models::ModelError);
  EXPECT_THROW(LoadSrdf("/nowhere.srdf", {}), models::ModelError);
}

TEST(SrdfTest, WhatIsWrittenIsRead) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.path() / "new.srdf";
  SaveDisabledPairs(file, "r", {{"hand", "arm", "Adjacent"}, {"base", "hand", "Never"}});
  EXPECT_THAT(LoadSrdf(file, kRobot).disabled_pairs, ElementsAre(Pair(0, 2), Pair(1, 2)));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new.srdf.part"));
}

TEST(SrdfTest, WritingReplacesTheComputedPairsOfAFileAndKeepsTheRest) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("old.srdf", R"(<?xml version="1.0"?>
<!-- hand-made -->
<robot name="r">
  <group name="g"><chain base_link="base" tip_link="hand"/></group>
  <disable_collisions link1="base" link2="hand" reason="Never"/>
  <disable_collisions link1="base" link2="arm" reason="User"/>
</robot>)");
  SaveDisabledPairs(file, "r", {{"hand", "arm", "Adjacent"}, {"arm", "base", "Always"}});
  EXPECT_THAT(LoadSrdf(file, kRobot).disabled_pairs, ElementsAre(Pair(0, 1), Pair(1, 2)));
  std::ifstream in(file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  EXPECT_THAT(text, AllOf(HasSubstr("hand-made"), HasSubstr("<chain"), HasSubstr("Adjacent"),
                          HasSubstr("User")));
  EXPECT_THAT(text, testing::Not(HasSubstr("Always"))) << "that pair stands there already";
}

TEST(SrdfTest, WritingRefusesAFileOfAnotherRobotAndLeavesItAsItIs) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("other.srdf", "<robot name='s'/>");
  EXPECT_THAT(
      [&] { SaveDisabledPairs(file, "r", {}); },
      ThrowsMessage<models::ModelError>(AllOf(HasSubstr("got 's'"), HasSubstr("expected 'r'"))));
  EXPECT_EQ(std::filesystem::file_size(file), 17u);
  EXPECT_THROW(SaveDisabledPairs(folder.Write("urdf", "<urdf/>"), "r", {}), models::ModelError);
  const auto urdf = folder.Write("r.urdf", "<robot name='r'><link name='l'/></robot>");
  EXPECT_THAT([&] { SaveDisabledPairs(urdf, "r", {}); },
              ThrowsMessage<models::ModelError>(HasSubstr("got a URDF")));
  EXPECT_THAT([&] { SaveDisabledPairs(folder.path() / "none" / "x.srdf", "r", {}); },
              ThrowsMessage<models::ModelError>(
                  HasSubstr("x.srdf: cannot be written; got No such file or directory; expected")));
}

}  // namespace srdf_test
}  // namespace oca::robot::test
