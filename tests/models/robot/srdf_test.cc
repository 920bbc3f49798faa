// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/srdf.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace srdf_test {

using testing::AllOf;
using testing::ElementsAre;
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
