// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/robot_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "oca/diagrams/record/mcap_reader.h"
#include "oca/models/robot/urdf.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace robot_record_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr char kHostile[] = "</script>'\"✋";

/// A turn about z at 0.3 m, a slide of at least 0.1 m along x, and a finger that mimics the slide.
std::string Arm(const std::string& name) {
  return R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="turned">
    <visual><origin xyz="0 0 0.05"/><geometry><sphere radius="0.05"/></geometry></visual>
    <inertial><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="9"/></inertial>
  </link>
  <link name="slid"><collision><geometry><sphere radius="0.05"/></geometry></collision>
    <inertial><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="8"/></inertial>
  </link>
  <link name=")" +
         name + R"("><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="turned"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 0 1"/><limit effort="5" velocity="0"/></joint>
  <joint name="slide" type="prismatic"><parent link="turned"/><child link="slid"/>
    <axis xyz="1 0 0"/><limit lower="0.1" upper="0.5" effort="5" velocity="0.25"/></joint>
  <joint name="finger" type="prismatic"><parent link="slid"/><child link=")" +
         name + R"("/>
    <axis xyz="0 2 0"/><mimic joint="slide" multiplier="-2" offset="0.1"/>
    <limit lower="-1" upper="1" effort="5" velocity="1"/></joint>
</robot>)";
}

class RobotRecordTest : public testing::Test {
 protected:
  /// The record of a robot, with the warnings of its load.
  RobotRecord Make(const std::string& urdf, robot::LoadOptions options = {}) {
    RobotSource source;
    source.file = "arm.urdf";
    source.srdf = options.srdf;
    source.remedy = "REMEDY";
    options.warn_each = [&](const std::string& line) { source.warnings.push_back(line); };
    RobotRecord record = RecordRobot(
        std::make_shared<const robot::RobotModel>(robot::ParseUrdf(urdf, "arm.urdf", options)),
        source);
    file_.emplace(McapFile::Parse(record.mcap, "robot"));
    EXPECT_TRUE(file_->complete()) << file_->problem();
    return record;
  }
  /// The only message of a topic.
  json Message(const char* topic) const {
    const auto messages = file_->MessagesOf(topic);
    EXPECT_THAT(messages, SizeIs(1)) << topic;
    return messages.empty() ? json() : json::parse(messages.front()->data);
  }

  std::optional<McapFile> file_;
};

TEST_F(RobotRecordTest, SaysLinksAndJointsAsTheyAre) {
  Make(Arm("finger"));
  const json robot = Message("/robot");
  EXPECT_EQ(robot["name"], "arm");
  EXPECT_EQ(robot["srdf"], json());
  ASSERT_THAT(robot["links"], SizeIs(4));
  EXPECT_EQ(robot["links"][1]["frame"], "arm/turned");
  EXPECT_EQ(robot["links"][1]["visuals"], json({"sphere"}));
  EXPECT_EQ(robot["links"][1]["collisions"], json::array());
  EXPECT_EQ(robot["links"][2]["mass"], 2.0);
  ASSERT_THAT(robot["joints"], SizeIs(3));
  const json& turn = robot["joints"][0];
  EXPECT_EQ(turn["type"], "continuous");
  EXPECT_EQ(turn["origin"], (json{{"xyz", {0.0, 0.0, 0.3}}, {"quaternion", {0.0, 0.0, 0.0, 1.0}}}));
  EXPECT_EQ(turn["lower"], json()) << "no limit";
  EXPECT_EQ(turn["effort"], 5.0);
  EXPECT_EQ(turn["mimics"], json());
  const json& slide = robot["joints"][1];
  EXPECT_EQ(slide["position"], 1);
  EXPECT_EQ(slide["parent"], 1);
  EXPECT_EQ(slide["child"], 2);
  EXPECT_EQ(slide["velocity"], 0.25);
  EXPECT_EQ(slide["acceleration"], json());
}

TEST_F(RobotRecordTest, WorksOutWhatAMimicFollows) {
  Make(Arm("finger"));
  const json finger = Message("/robot")["joints"][2];
  EXPECT_EQ(finger["mimics"], "slide");
  EXPECT_EQ(finger["position"], 1);
  EXPECT_EQ(finger["multiplier"], -2.0);
  EXPECT_EQ(finger["offset"], 0.1);
  EXPECT_EQ(finger["axis"], json({0.0, 1.0, 0.0})) << "a unit vector";
}

// The slide cannot be at 0.
TEST_F(RobotRecordTest, StandsWhereItIsAsNearToZeroAsItMay) {
  Make(Arm("finger"));
  const json positions = Message("/robot")["positions"];
  ASSERT_THAT(positions, SizeIs(2));
  EXPECT_EQ(positions[0]["start"], 0.0);
  EXPECT_EQ(positions[0]["unit"], "rad");
  EXPECT_EQ(positions[0]["lower"], json());
  EXPECT_NEAR(positions[0]["range"][1].get<double>(), 3.14159265, 1e-8);
  EXPECT_EQ(positions[1]["start"], 0.1);
  EXPECT_EQ(positions[1]["unit"], "m");
  EXPECT_EQ(positions[1]["range"], json({0.1, 0.5}));
  const json transforms = Message("/tf")["transforms"];
  ASSERT_THAT(transforms, SizeIs(4));
  EXPECT_EQ(transforms[2]["child_frame_id"], "arm/slid");
  EXPECT_EQ(transforms[2]["translation"], (json{{"x", 0.1}, {"y", 0}, {"z", 0.3}}));
  EXPECT_EQ(transforms[3]["translation"], (json{{"x", 0.1}, {"y", -0.1}, {"z", 0.3}}));
}

TEST_F(RobotRecordTest, DrawsVisualsAndCollisionShapesApart) {
  Make(Arm("finger"));
  const json drawn = Message("/scene/robots")["entities"];
  const json shapes = Message("/scene/collisions")["entities"];
  ASSERT_THAT(drawn, SizeIs(4));
  ASSERT_THAT(shapes, SizeIs(4));
  EXPECT_THAT(drawn[0]["cubes"], IsEmpty()) << "its collision shape is no visual";
  EXPECT_THAT(drawn[1]["spheres"], SizeIs(1));
  EXPECT_THAT(shapes[0]["cubes"], SizeIs(1));
  EXPECT_THAT(shapes[1]["spheres"], IsEmpty());
  EXPECT_EQ(shapes[0]["frame_id"], drawn[0]["frame_id"]);
  EXPECT_NE(shapes[0]["id"], drawn[0]["id"]);
}

// Links 0 and 2 are two joints apart, and 2 and 3 neighbours; link 1 has no shape.
TEST_F(RobotRecordTest, NamesThePairsThatAreChecked) {
  Make(Arm("finger"));
  EXPECT_EQ(Message("/robot")["own_pairs"], json({{0, 2}, {0, 3}}));
  const oca::test::TemporaryFolder folder;
  robot::LoadOptions options;
  options.srdf = folder.Write(
      "arm.srdf",
      R"(<robot name="arm"><disable_collisions link1="slid" link2="base" reason="Never"/></robot>)");
  Make(Arm("finger"), options);
  EXPECT_EQ(Message("/robot")["own_pairs"], json({{0, 3}}));
  EXPECT_EQ(Message("/robot")["disabled_pairs"], 1);
  EXPECT_EQ(Message("/robot")["srdf"], options.srdf.string());
}

TEST_F(RobotRecordTest, TellsOfMorePairsThanThePageLooksAt) {
  const auto chain = [&](int links) {
    std::string urdf = "<robot name='chain'>";
    for (int i = 0; i < links; ++i) {
      const std::string number = std::to_string(i);
      urdf += "<link name='l" + number +
              "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
      if (i == 0) continue;
      urdf += "<joint name='j" + number + "' type='continuous'><parent link='l" +
              std::to_string(i - 1) + "'/><child link='l" + number + "'/></joint>";
    }
    return Make(urdf + "</robot>").warnings;
  };
  EXPECT_THAT(chain(600), testing::Not(testing::Contains(HasSubstr("contacts of own links"))));
  // 640 * 639 / 2, without the 639 of adjacent ones
  EXPECT_THAT(chain(640), testing::Contains("contacts of own links are not marked: got 203841 "
                                            "pairs; expected at most 200000"));
}

TEST_F(RobotRecordTest, PutsWarningsAtTheLinksThatTheySpeakOf) {
  const RobotRecord record = Make(Arm("finger"));
  const json warnings = Message("/robot")["warnings"];
  ASSERT_THAT(record.warnings, SizeIs(4));
  ASSERT_THAT(warnings, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(warnings[i]["text"], record.warnings[i]);
  EXPECT_THAT(record.warnings[0], HasSubstr("link 'turned' has principal moments"));
  EXPECT_EQ(warnings[0]["links"], json({1}));
  EXPECT_EQ(warnings[1]["links"], json({2}));
  EXPECT_THAT(record.warnings[2], HasSubstr("joint 'turn': velocity limit 0"));
  EXPECT_EQ(warnings[2]["links"], json({1})) << "the link that the joint leads to";
  EXPECT_THAT(record.warnings[3], HasSubstr("turned; REMEDY takes what is drawn"));
  EXPECT_EQ(warnings[3]["links"], json({1}));
}

TEST_F(RobotRecordTest, TellsAMeshThatCannotBeDrawn) {
  const oca::test::TemporaryFolder folder;
  folder.Write("bad.stl", "no mesh at all");
  const auto mesh = (folder.path() / "bad.stl").string();
  const RobotRecord record = Make(R"(<robot name="r"><link name="only"><visual><geometry>
      <mesh filename=")" + mesh + R"("/></geometry></visual><collision><geometry>
      <sphere radius="1"/></geometry></collision></link></robot>)");
  ASSERT_THAT(record.warnings, SizeIs(1));
  EXPECT_THAT(record.warnings[0], HasSubstr("link 'only': not drawn: "));
  EXPECT_THAT(record.warnings[0], HasSubstr("bad.stl"));
  EXPECT_EQ(Message("/robot")["warnings"][0]["links"], json::array({0}));
}

TEST_F(RobotRecordTest, KeepsNamesWhateverTheyAre) {
  Make(Arm("&lt;/script&gt;&apos;&quot;✋"));
  const json robot = Message("/robot");
  EXPECT_EQ(robot["links"][3]["name"], kHostile);
  EXPECT_EQ(robot["links"][3]["frame"], std::string("arm/") + kHostile);
  EXPECT_EQ(Message("/scene/collisions")["entities"][3]["frame_id"], robot["links"][3]["frame"]);
  EXPECT_EQ(Message("/tf")["transforms"][3]["child_frame_id"], robot["links"][3]["frame"]);
}

// What stands in quotes could be j, or the whole of the other name.
TEST_F(RobotRecordTest, TakesTheLongestNameThatStandsThere) {
  Make(R"(<robot name="r"><link name="a"><collision><geometry><sphere radius="1"/></geometry>
      </collision></link><link name="b"/><link name="c"/>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <limit effort="1" velocity="1"/></joint>
    <joint name="j', 'k" type="continuous"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/>
      <limit effort="1" velocity="0"/></joint></robot>)");
  const json warnings = Message("/robot")["warnings"];
  ASSERT_THAT(warnings, testing::Not(IsEmpty()));
  EXPECT_THAT(warnings[0]["text"].get<std::string>(),
              HasSubstr("joint 'j', 'k': velocity limit 0"));
  EXPECT_EQ(warnings[0]["links"], json({2}));
}

}  // namespace robot_record_test
}  // namespace oca::record
