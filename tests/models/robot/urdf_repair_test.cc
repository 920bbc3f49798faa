// SPDX-License-Identifier: BSD-3-Clause
// What nothing here reads is taken out of a description with a word about it, instead of a refusal.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot::test {
namespace urdf_repair_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

struct Loaded {
  RobotModel model;
  std::vector<std::string> warnings;
};

Loaded Load(const std::string& content) {
  std::vector<std::string> warnings;
  LoadOptions options;
  options.warn = [&](const std::string& line) { warnings.push_back(line); };
  RobotModel model = ParseUrdf("<robot name='r'>\n" + content + "\n</robot>", "r.urdf", options);
  return {std::move(model), std::move(warnings)};
}

Loaded LoadLink(const std::string& content) {
  return Load("<link name='arm'>" + content + "</link>");
}

const std::string kShape = "<geometry><sphere radius='1'/></geometry>";

TEST(UrdfRepairTest, KindsAreSummedUpOrToldEach) {
  std::string links;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    links += fmt::format(
        "<link name='{}'><visual><geometry><box size='0 0 0'/></geometry>"
        "</visual></link>\n",
        name);
    if (*name == 'a') continue;
    links += fmt::format(
        "<joint name='j{}' type='fixed'><parent link='a'/><child link='{}'/>"
        "</joint>",
        name, name);
  }
  std::vector<std::string> sums, each;
  LoadOptions options;
  options.warn = [&](const std::string& line) { sums.push_back(line); };
  options.warn_each = [&](const std::string& line) { each.push_back(line); };
  ParseUrdf("<robot name='r'>\n" + links + "</robot>", "r.urdf", options);
  EXPECT_THAT(sums, ElementsAre(AllOf(HasSubstr("link 'c'"), HasSubstr("and 2 more"))));
  ASSERT_EQ(each.size(), 5u);
  EXPECT_THAT(each[4],
              HasSubstr("visuals without a place, a shape or its size, not drawn: of link 'e'"));
}

TEST(UrdfRepairTest, NothingIsSaidOfWhatIsRight) {
  EXPECT_THAT(LoadLink("<visual>" + kShape + "<material name='a'><color rgba='1 0 0 1'/>" +
                       "</material></visual><inertial><mass value='1'/><inertia ixx='1' ixy='0' "
                       "ixz='0' iyy='1' iyz='0' izz='1'/></inertial>")
                  .warnings,
              IsEmpty());
}

TEST(UrdfRepairTest, AnEffortThatIsMissingOrNoneCountsAsNotGiven) {
  for (const char* effort : {"", "effort='abc'", "effort='-1'", "effort='nan'"}) {
    const Loaded loaded = Load(
        "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>"
        "<child link='b'/><limit lower='-1' upper='1' velocity='2' " +
        std::string(effort) + "/></joint>");
    EXPECT_EQ(loaded.model.effort_limits()[0], kUnlimited) << effort;
    EXPECT_EQ(loaded.model.velocity_limits()[0], 2.0) << effort;
    EXPECT_THAT(loaded.warnings, testing::Contains(HasSubstr("no effort limit"))) << effort;
  }
}

TEST(UrdfRepairTest, AVelocityThatIsMissingCountsAsNotGiven) {
  for (const char* limit : {"<limit lower='-1' upper='1' effort='1'/>",
                            "<limit lower='-1' upper='1' effort='1' velocity='0'/>"}) {
    const Loaded loaded = Load(
        "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>"
        "<child link='b'/>" +
        std::string(limit) + "</joint>");
    EXPECT_EQ(loaded.model.velocity_limits()[0], kUnlimited) << limit;
    EXPECT_EQ(loaded.model.upper_limits()[0], 1.0) << limit;
    EXPECT_THAT(loaded.warnings,
                testing::Contains(HasSubstr("joint 'j': velocity limit 0 or none")))
        << limit;
  }
}

TEST(UrdfRepairTest, InertiasThatAreNoneAreLeftOut) {
  const std::string inertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";
  for (const std::string& content :
       {"<mass value='-1'/>" + inertia, "<mass value='nan'/>" + inertia, inertia,
        std::string("<mass value='1'/>"), std::string("<mass value='1'/><inertia ixx='1'/>"),
        "<mass value='1'/><origin xyz='a b c'/>" + inertia,
        "<mass value='1'/><origin quat_xyzw='0 0 0 0'/>" + inertia}) {
    const Loaded loaded = LoadLink("<inertial>" + content + "</inertial>");
    EXPECT_EQ(loaded.model.links()[0].inertia.mass, 0.0) << content;
    EXPECT_THAT(loaded.warnings, ElementsAre(AllOf(HasSubstr("inertias that are incomplete"),
                                                   HasSubstr("of link 'arm' (line 2)"))))
        << content;
  }
}

TEST(UrdfRepairTest, InertiasThatNoBodyCanHaveAreKeptAndToldOnce) {
  const std::string spindle =
      "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='2.1'/>"
      "</inertial>";
  const Loaded loaded = Load("<link name='a'>" + spindle + "</link><link name='b'>" + spindle +
                             "</link><joint name='j' type='fixed'><parent link='a'/>"
                             "<child link='b'/></joint>");
  EXPECT_EQ(loaded.model.links()[1].inertia.mass, 1.0);
  EXPECT_THAT(loaded.warnings,
              ElementsAre(AllOf(HasSubstr("inertias that no body can have"),
                                HasSubstr("link 'a' has principal moments 1, 1, 2.1"),
                                HasSubstr("and 1 more link"))));
}

TEST(UrdfRepairTest, TheFirstMaterialCountsAndColoursAreFourNumbers) {
  const Loaded loaded = Load(
      "<material name='grey'><color rgba='0.5 0.5 0.5 1'/></material>\n"
      "<material name='grey'><color rgba='0.5 0.5 0.5 1'/></material>\n"
      "<material name='loud'><color rgba='128 0 0 255'/></material>\n"
      "<link name='arm'><visual>" +
      kShape + "<material name='red'><color rgba='1 0 0 1'/>" +
      "</material><material name='grey'/></visual></link>");
  EXPECT_EQ(loaded.model.links()[0].visuals[0].colour, Eigen::Vector4d(1, 0, 0, 1));
  EXPECT_THAT(loaded.warnings,
              ElementsAre(HasSubstr("beside another one, left out: of link 'arm' (line 5)"),
                          HasSubstr("there already, left out: 'grey' (line 3)"),
                          HasSubstr("four numbers from 0 to 1, left out: 'loud' (line 4)")));
}

TEST(UrdfRepairTest, AMaterialOfTheRobotThatIsNoColourIsLeftOut) {
  for (const char* colour : {"", "<color/>", "<texture/>", "<color rgba='1 0 0'/>"}) {
    const Loaded loaded = Load("<material name='red'>" + std::string(colour) +
                               "</material><link name='arm'><visual>" + kShape +
                               "<material name='red'/></visual></link>");
    EXPECT_EQ(loaded.model.links()[0].visuals.size(), 1u) << colour;
    EXPECT_THAT(loaded.warnings,
                ElementsAre(HasSubstr("four numbers from 0 to 1, left out: 'red' (line 2)")))
        << colour;
  }
  EXPECT_THAT(Load("<material name='wood'><texture filename='wood.png'/></material>"
                   "<link name='arm'/>")
                  .warnings,
              IsEmpty());
}

TEST(UrdfRepairTest, ACapsuleMayHaveAttributesThatUrdfDoesNotHave) {
  const Loaded loaded = LoadLink(
      "<collision><geometry><capsule radius='1' length='2' segments='9'/></geometry></collision>");
  EXPECT_EQ(std::get<geometry::Capsule>(loaded.model.links()[0].collisions[0].shape).length, 2.0);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("'segments' of")));
}

TEST(UrdfRepairTest, NumbersMayStandInSeveralLines) {
  const Loaded loaded = LoadLink(
      "<inertial><mass value=' 2\n'/><inertia ixx='1 ' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
      "</inertial><collision><origin xyz='1\t2\r\n   3 '/><geometry><box size='\n1 2\n3'/>"
      "</geometry></collision>");
  EXPECT_EQ(loaded.model.links()[0].collisions[0].X_LC.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(loaded.model.links()[0].inertia.mass, 2.0);
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST(UrdfRepairTest, VisualsOfNoSizeAreNotDrawn) {
  const Loaded loaded = LoadLink(
      "<visual><geometry><box size='0 1 1'/></geometry></visual>"
      "<visual>" +
      kShape + "</visual>");
  EXPECT_EQ(loaded.model.links()[0].visuals.size(), 1u);
  EXPECT_THAT(loaded.warnings,
              ElementsAre(HasSubstr("visuals without a place, a shape or its size, not drawn")));
  EXPECT_THROW(LoadLink("<collision><geometry><box size='0 1 1'/></geometry></collision>"),
               models::ModelError);
}

TEST(UrdfRepairTest, AVisualWhoseMeshIsMissingIsNotDrawnAndACollisionMustBeThere) {
  const std::string mesh = "<geometry><mesh filename='package://lost/pretty.dae'/></geometry>";
  const Loaded loaded = LoadLink("<visual>" + mesh + "</visual><visual>" + mesh +
                                 "</visual><collision>" + kShape + "</collision>");
  EXPECT_THAT(loaded.model.links()[0].visuals, IsEmpty());
  EXPECT_THAT(loaded.warnings,
              ElementsAre(AllOf(HasSubstr("not drawn: r.urdf:2: link 'arm' visual: missing mesh"),
                                HasSubstr("and 1 more visual"))));
  EXPECT_THROW(LoadLink("<collision>" + mesh + "</collision>"), models::ModelError);
}

TEST(UrdfRepairTest, AttributesThatUrdfDoesNotHaveAreLeftOutButSlipsAreRefused) {
  const Loaded loaded = LoadLink(
      "<collision a:b='1'><origin xyz='0 0 1' comment='x'/><geometry>"
      "<sphere radius='1' segments='20'/></geometry></collision>");
  EXPECT_EQ(loaded.model.links()[0].collisions[0].X_LC.translation().z(), 1.0);
  EXPECT_THAT(loaded.warnings,
              ElementsAre(AllOf(HasSubstr("attributes that URDF does not have, left out"),
                                HasSubstr("'a:b' of <collision>"), HasSubstr("'comment'"),
                                HasSubstr("'segments' of <sphere> (line 2)"))));
  EXPECT_THAT([] { LoadLink("<collision><origin xzy='0 0 1'/>" + kShape + "</collision>"); },
              ThrowsMessage<models::ModelError>(HasSubstr("unknown attribute; got 'xzy'")));
}

TEST(UrdfRepairTest, AFreeRootIsHeldAndAnyOtherFreeJointIsRefused) {
  const auto joint = [](const char* type, const char* parent, const char* child) {
    return std::string("<joint name='") + child + "_joint' type='" + type + "'><parent link='" +
           parent + "'/><child link='" + child + "'/></joint>\n";
  };
  const std::string links = "<link name='world'/><link name='base'/><link name='arm'/>\n";
  for (const char* type : {"floating", "planar"}) {
    const Loaded loaded =
        Load(links + joint(type, "world", "base") + joint("fixed", "base", "arm"));
    EXPECT_EQ(loaded.model.num_positions(), 0);
    EXPECT_THAT(loaded.warnings,
                ElementsAre(AllOf(HasSubstr("held where base_pose puts it"),
                                  HasSubstr(std::string(type) + " 'base_joint' (line 3)"))));
    EXPECT_THAT([&] { Load(links + joint("fixed", "world", "base") + joint(type, "base", "arm")); },
                ThrowsMessage<models::ModelError>(HasSubstr("unsupported joint type")));
  }
}

TEST(UrdfRepairTest, AVisualThatNobodyCanDrawIsNotDrawn) {
  for (const char* visual :
       {"<geometry/>", "", "<geometry><torus radius='1'/></geometry>",
        "<geometry><sphere radius='nan'/></geometry>", "<geometry><box size='1 -1 1'/></geometry>",
        "<geometry><cylinder radius='1'/></geometry>", "<geometry><mesh/></geometry>",
        "<geometry><mesh filename=''/></geometry>",
        "<geometry><sphere radius='1'/><sphere radius='2'/></geometry>",
        "<origin xyz='a b'/><geometry><sphere radius='1'/></geometry>",
        "<origin quat_xyzw='0 0 0 0'/><geometry><sphere radius='1'/></geometry>",
        "<geometry><capsule radius='1' length='-1'/></geometry>"}) {
    const Loaded loaded = LoadLink("<visual>" + std::string(visual) + "</visual><visual>" + kShape +
                                   "</visual><collision>" + kShape + "</collision>");
    EXPECT_EQ(loaded.model.links()[0].visuals.size(), 1u) << visual;
    EXPECT_EQ(loaded.model.links()[0].collisions.size(), 1u) << visual;
    EXPECT_THAT(loaded.warnings,
                ElementsAre("visuals without a place, a shape or its size, not drawn: of link "
                            "'arm' (line 2)"))
        << visual;
    // What the arm collides with is no picture.
    EXPECT_THROW(LoadLink("<collision>" + std::string(visual) + "</collision>"),
                 models::ModelError);
  }
}

std::string Joint(const std::string& type, const std::string& inner) {
  return "<link name='a'/><link name='b'/>\n<joint name='j' type='" + type +
         "'><parent link='a'/><child link='b'/>" + inner + "</joint>";
}

TEST(UrdfRepairTest, WhatNothingReadsOfAJointIsLeftOut) {
  const std::string limit = "<limit lower='-1' upper='2' effort='3' velocity='1'/>";
  for (const char* inner :
       {"<dynamics/>", "<dynamics damping='0,5'/>", "<dynamics friction='nan'/>",
        "<calibration rising='x'/>", "<calibration/>", "<safety_controller/>",
        "<safety_controller k_velocity='1' soft_lower_limit='x'/>",
        "<dynamics damping='1'/><dynamics damping='2'/>"}) {
    const Loaded loaded = Load(Joint("revolute", limit + inner));
    EXPECT_EQ(loaded.model.num_positions(), 1) << inner;
    EXPECT_EQ(loaded.model.upper_limits()[0], 2.0) << inner;
    EXPECT_THAT(loaded.warnings, ElementsAre(AllOf(HasSubstr("left out: "), HasSubstr("'j'"),
                                                   HasSubstr("(line 3)"))))
        << inner;
  }
  EXPECT_THAT(Load(Joint("revolute", limit + "<dynamics damping='0.5' friction='0'/>")).warnings,
              IsEmpty());
  for (const char* inner : {"<limit lower='x'/>", "<axis xyz='0 0 0'/>", "<axis xyz='up'/>"}) {
    EXPECT_THAT(Load(Joint("fixed", inner)).warnings, IsEmpty()) << inner;
  }
  EXPECT_THAT(Load(Joint("fixed", "") + "<material/>").warnings,
              ElementsAre(HasSubstr("materials without a name, left out")));
}

TEST(UrdfRepairTest, AnEndOfARangeThatIsLeftOutIsZero) {
  const Loaded upper = Load(Joint("revolute", "<limit upper='2' effort='1' velocity='1'/>"));
  EXPECT_EQ(upper.model.lower_limits()[0], 0.0);
  EXPECT_EQ(upper.model.upper_limits()[0], 2.0);
  EXPECT_THAT(upper.warnings, ElementsAre("limits that say one end of the range, 0 at the other: "
                                          "no lower of joint 'j' (line 3)"));
  const Loaded lower = Load(Joint("prismatic", "<limit lower='-2' effort='1' velocity='1'/>"));
  EXPECT_EQ(lower.model.lower_limits()[0], -2.0);
  EXPECT_EQ(lower.model.upper_limits()[0], 0.0);
  EXPECT_THAT([] { Load(Joint("revolute", "<limit effort='1' velocity='1'/>")); },
              ThrowsMessage<models::ModelError>(HasSubstr("lower; got nothing")));
  // Ends that would be no range are not made up, nor those that nothing reads.
  EXPECT_THAT([] { Load(Joint("revolute", "<limit lower='0.5' velocity='1'/>")); },
              ThrowsMessage<models::ModelError>(HasSubstr("upper; got nothing")));
  EXPECT_THAT(Load(Joint("continuous", "<limit upper='2' effort='1' velocity='1'/>")).warnings,
              IsEmpty());
  EXPECT_THAT([] { Load(Joint("revolute", "<limit lowr='-1' upper='2' velocity='1'/>")); },
              ThrowsMessage<models::ModelError>(HasSubstr("unknown attribute; got 'lowr'")));
}

}  // namespace urdf_repair_test
}  // namespace oca::robot::test
