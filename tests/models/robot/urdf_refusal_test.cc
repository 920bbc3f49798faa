// SPDX-License-Identifier: BSD-3-Clause
// Every refusal of a robot description, with the place it must name.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace urdf_refusal_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

void ExpectRefused(const std::string& text, const char* reason, const char* element = "") {
  EXPECT_THAT([&] { ParseUrdf(text, "bad.urdf"); },
              ThrowsMessage<models::ModelError>(AllOf(HasSubstr("bad.urdf"), HasSubstr(reason),
                                                      HasSubstr(element), HasSubstr("; got "),
                                                      HasSubstr("; expected "))))
      << text;
}

std::string Robot(const std::string& content) {
  return "<robot name='r'>\n" + content + "\n</robot>";
}

// One link with the given content.
std::string Link(const std::string& content) {
  return Robot("<link name='arm'>" + content + "</link>");
}

std::string Collision(const std::string& shape) {
  return Link("<collision><geometry>" + shape + "</geometry></collision>");
}

// Two links and a joint of that type with the given content.
std::string Joint(const std::string& type, const std::string& content) {
  return Robot("<link name='a'/><link name='b'/>\n<joint name='elbow' type='" + type +
               "'><parent link='a'/><child link='b'/>" + content + "</joint>");
}

const std::string kLimit = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";

TEST(UrdfRefusalTest, TheExamplesBelowAreOtherwiseSound) {
  EXPECT_NO_THROW(ParseUrdf(Link(""), "good.urdf"));
  EXPECT_NO_THROW(ParseUrdf(Collision("<sphere radius='1'/>"), "good.urdf"));
  EXPECT_NO_THROW(ParseUrdf(Joint("revolute", kLimit), "good.urdf"));
  EXPECT_NO_THROW(ParseUrdf(Joint("continuous", ""), "good.urdf"));
}

TEST(UrdfRefusalTest, FilesThatAreNoRobot) {
  EXPECT_THAT([] { LoadUrdf("/nowhere/arm.urdf"); },
              ThrowsMessage<models::ModelError>(HasSubstr("/nowhere/arm.urdf")));
  ExpectRefused("", "nothing");
  ExpectRefused(std::string("\x7f"
                            "ELF\0\0\0",
                            7),
                "XML");
  ExpectRefused("<robot name='r'>", "inside <robot>");
  ExpectRefused("<sdf/>", "root element");
  ExpectRefused("<robot><link name='a'/></robot>", "name");
  ExpectRefused("<robot name='r'/>", "at least one <link>");
}

TEST(UrdfRefusalTest, DepthBombs) {
  std::string bomb;
  for (int i = 0; i < 200'000; ++i) bomb += "<link name='a'>";
  ExpectRefused("<robot name='r'>" + bomb, "more than 64");
}

TEST(UrdfRefusalTest, UnexpandedXacro) {
  ExpectRefused(Robot("<xacro:property name='x' value='1'/><link name='a'/>"), "xacro");
  ExpectRefused(Collision("<sphere radius='${r}'/>"), "xacro", "'arm'");
  ExpectRefused(Robot("<link name='$(arg prefix)arm'/>"), "xacro");
  ExpectRefused(Robot("<link name='a'/><gazebo><x y='${z}'/></gazebo>"), "xacro");
}

TEST(UrdfRefusalTest, GeometryThatUrdfdomWouldDropInSilence) {
  ExpectRefused(Collision("<torus radius='1' length='2'/>"), "unknown geometry", "'arm'");
  ExpectRefused(Collision(""), "shapes; got none", "'arm'");
  ExpectRefused(Collision("<sphere radius='1'/><sphere radius='2'/>"), "several");
  ExpectRefused(Link("<collision/>"), "geometry; got none", "'arm'");
}

TEST(UrdfRefusalTest, SizesThatAreNotPositive) {
  for (const char* shape :
       {"<sphere radius='0'/>", "<sphere radius='-1'/>", "<box size='1 0 1'/>",
        "<box size='1 -1 1'/>", "<cylinder radius='0' length='1'/>",
        "<cylinder radius='1' length='0'/>", "<cylinder radius='1' length='-1'/>"}) {
    ExpectRefused(Collision(shape), "more than 0", "bad.urdf:2: link 'arm'");
  }
  ExpectRefused(Collision("<mesh filename='a.stl' scale='1 0 1'/>"), "no zero");
  EXPECT_NO_THROW(ParseUrdf(Collision("<sphere radius='1e-9'/>"), "good.urdf"));
}

TEST(UrdfRefusalTest, NumbersThatAreMissingOrTooMany) {
  for (const char* shape : {"<sphere/>", "<sphere radius=''/>", "<sphere radius='1 2'/>",
                            "<box size='1 2'/>", "<box size='1 2 3 4'/>", "<cylinder radius='1'/>",
                            "<mesh filename='a.stl' scale='2'/>", "<sphere radius='one'/>"}) {
    ExpectRefused(Collision(shape), "number", "'arm'");
  }
  ExpectRefused(Collision("<mesh/>"), "filename");
}

TEST(UrdfRefusalTest, NumbersThatAreNotFinite) {
  for (const std::string bad : {"nan", "inf", "-inf", "1e999"}) {
    ExpectRefused(Collision("<sphere radius='" + bad + "'/>"), "finite", "'arm'");
    ExpectRefused(Collision("<box size='1 1 " + bad + "'/>"), "finite", "'arm'");
    ExpectRefused(Joint("fixed", "<origin xyz='0 0 " + bad + "'/>"), "finite", "'elbow'");
    ExpectRefused(Joint("fixed", "<origin rpy='0 0 " + bad + "'/>"), "finite", "'elbow'");
    ExpectRefused(Joint("continuous", "<axis xyz='0 0 " + bad + "'/>"), "finite", "'elbow'");
    ExpectRefused(
        Joint("revolute", "<limit lower='0' velocity='1' effort='1' upper='" + bad + "'/>"),
        "finite", "'elbow'");
    ExpectRefused(
        Joint("revolute", "<limit lower='0' upper='1' effort='1' velocity='" + bad + "'/>"),
        "finite", "'elbow'");
  }
}

TEST(UrdfRefusalTest, ZeroAxis) {
  ExpectRefused(Joint("revolute", kLimit + "<axis xyz='0 0 0'/>"), "a direction", "'elbow'");
  ExpectRefused(Joint("continuous", "<axis xyz='0 0 1e-7'/>"), "a direction", "'elbow'");
  EXPECT_NO_THROW(ParseUrdf(Joint("continuous", "<axis xyz='0 0 2e-6'/>"), "good.urdf"));
  EXPECT_NO_THROW(ParseUrdf(Joint("fixed", "<axis xyz='0 0 0'/>"), "good.urdf"));
}

TEST(UrdfRefusalTest, NumbersThatNoRobotHasAreToldWithTheirLine) {
  ExpectRefused(Joint("revolute", "<axis xyz='0 1e200 1e200'/>" + kLimit),
                "bad.urdf:3: joint 'elbow' <axis>: xyz; got '0 1e200 1e200'; expected a direction, "
                "of a length from 1e-06 to 1e+06");
  EXPECT_NO_THROW(ParseUrdf(Joint("revolute", "<axis xyz='0 0 1e6'/>" + kLimit), "good.urdf"));
  ExpectRefused(
      Joint("revolute", "<origin xyz='0 0 -1.1e6'/>" + kLimit),
      "bad.urdf:3: joint 'elbow' <origin>: xyz; got '0 0 -1.1e6'; expected at most 1e+06");
  EXPECT_NO_THROW(ParseUrdf(Joint("revolute", "<origin xyz='0 0 -1e6'/>" + kLimit), "good.urdf"));
  ExpectRefused(Link("<collision><origin xyz='1e15 0 0'/><geometry><sphere radius='1'/></geometry>"
                     "</collision>"),
                "bad.urdf:2: link 'arm' <origin>: xyz; got '1e15 0 0'");
  const auto limit = [](const char* velocity) {
    return std::string("<limit lower='-1' upper='1' effort='1' velocity='") + velocity + "'/>";
  };
  ExpectRefused(
      Joint("revolute", limit("9e-7")),
      "bad.urdf:3: joint 'elbow' <limit>: velocity; got 9e-07; expected 0 or more, and at "
      "least 1e-06");
  EXPECT_NO_THROW(ParseUrdf(Joint("revolute", limit("1e-6")), "good.urdf"));
}

TEST(UrdfRefusalTest, LimitsThatAreMissingOrReversed) {
  ExpectRefused(Joint("revolute", ""), "limit; got none", "'elbow'");
  ExpectRefused(Joint("prismatic", ""), "limit; got none", "'elbow'");
  ExpectRefused(Joint("revolute", "<limit velocity='1' effort='1'/>"), "lower", "'elbow'");
  ExpectRefused(Joint("revolute", "<limit lower='1' upper='0.9' velocity='1' effort='1'/>"),
                "lower <= upper", "'elbow'");
  EXPECT_NO_THROW(ParseUrdf(
      Joint("revolute", "<limit lower='1' upper='1' velocity='1' effort='1'/>"), "good.urdf"));
  ExpectRefused(Joint("revolute", "<limit lower='0' upper='1' velocity='-1' effort='1'/>"),
                "0 or more", "'elbow'");
  ExpectRefused(
      Joint("revolute", "<limit lower='0' upper='1' velocity='1' effort='1' acceleration='0'/>"),
      "more than 0", "'elbow'");
}

TEST(UrdfRefusalTest, JointTypesThatAreNotSupported) {
  for (const char* type : {"ball", ""}) {
    ExpectRefused(Joint(type, ""), "unsupported joint type", "'elbow'");
  }
}

TEST(UrdfRefusalTest, JointsToUnknownLinks) {
  ExpectRefused(Robot("<link name='arm'/><joint name='j' type='fixed'><parent link='amr'/>"
                      "<child link='arm'/></joint>"),
                "nearest is 'arm'", "unknown parent link");
  ExpectRefused(Robot("<link name='arm'/><joint name='j' type='fixed'><parent link='arm'/>"
                      "<child link='hand'/></joint>"),
                "'hand'", "unknown child link");
  ExpectRefused(
      Robot("<link name='arm'/><joint name='j' type='fixed'><parent link='arm'/></joint>"),
      "a <child>");
}

std::string Fixed(const std::string& name, const std::string& parent, const std::string& child) {
  return "<joint name='" + name + "' type='fixed'><parent link='" + parent + "'/><child link='" +
         child + "'/></joint>";
}

TEST(UrdfRefusalTest, TwoRoots) {
  ExpectRefused(Robot("<link name='a'/><link name='b'/>"), "root link", "'a' and 'b'");
}

TEST(UrdfRefusalTest, Loops) {
  const std::string links = "<link name='a'/><link name='b'/><link name='c'/>";
  ExpectRefused(Robot(links + Fixed("1", "a", "b") + Fixed("2", "b", "c") + Fixed("3", "c", "a")),
                "loop");
  ExpectRefused(Robot(links + Fixed("1", "b", "c") + Fixed("2", "c", "b")), "loop");
  ExpectRefused(Robot(links + Fixed("1", "a", "b") + Fixed("2", "a", "c") + Fixed("3", "b", "c")),
                "a loop: joint '2'", "joint '3'");
  ExpectRefused(Robot("<link name='a'/>" + Fixed("1", "a", "a")), "loop");
}

TEST(UrdfRefusalTest, MimicOfAnUnknownJointOrInALoop) {
  ExpectRefused(Joint("revolute", kLimit + "<mimic joint='elbwo'/>"), "nearest is 'elbow'",
                "unknown joint");
  ExpectRefused(Joint("revolute", kLimit + "<mimic joint='elbow'/>"), "loop");
  ExpectRefused(Joint("revolute", kLimit + "<mimic/>"), "got nothing", "<mimic>: joint");
  ExpectRefused(Joint("revolute", kLimit + "<mimic joint='elbow' multiplier='nan'/>"), "finite");
  const auto mimic = [](const char* name, const char* child, const char* master) {
    return std::string("<joint name='") + name +
           "' type='continuous'><parent link='a'/><child link='" + child + "'/><mimic joint='" +
           master + "'/></joint>";
  };
  const std::string links = "<link name='a'/><link name='b'/><link name='c'/>";
  ExpectRefused(Robot(links + mimic("p", "b", "q") + mimic("q", "c", "p")), "mimic rules");
  ExpectRefused(Robot(links + Fixed("still", "a", "b") + mimic("q", "c", "still")),
                "a fixed joint");
}

TEST(UrdfRefusalTest, NamesThatAreTakenOrMissing) {
  ExpectRefused(Robot("<link name='a'/><link name='a'/>"), "one that is taken", "link 'a'");
  ExpectRefused(Robot("<link name='a'/><link name='b'/><link name='c'/>" + Fixed("j", "a", "b") +
                      Fixed("j", "a", "c")),
                "one that is taken", "joint 'j'");
  ExpectRefused(Robot("<link/>"), "name");
}

TEST(UrdfRefusalTest, ElementsThatAreMisspeltOrRepeated) {
  ExpectRefused(Robot("<lnik name='a'/>"), "expected link");
  ExpectRefused(Link("<colision/>"), "expected collision", "'arm'");
  ExpectRefused(Joint("fixed", "<orgin xyz='1 0 0'/>"), "expected origin", "'elbow'");
  ExpectRefused(Joint("fixed", "<origin xzy='1 0 0'/>"), "'xzy'", "'elbow'");
  ExpectRefused(Joint("fixed", "<origin xyz='1 0 0'/><origin xyz='2 0 0'/>"), "a second one");
  EXPECT_NO_THROW(ParseUrdf(Link("<drake:proximity_properties/>"), "good.urdf"));
}

TEST(UrdfRefusalTest, DamagedTextIsReadOrRefusedButNeverCrashes) {
  std::ifstream stream(ProductFile("robots/planar2/planar2.urdf"));
  const std::string sound{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_GT(sound.size(), 1000u);
  Random random(71);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = sound;
    const auto place = [&] { return static_cast<std::size_t>(Uniform(random, 0, text.size())); };
    if (i % 3 == 0) text.resize(place());
    if (i % 3 == 1) text[place()] = static_cast<char>(static_cast<int>(Uniform(random, 0, 256)));
    if (i % 3 == 2) text.insert(place(), sound, place(), 40);
    try {
      EXPECT_EQ(ParseUrdf(text, "bad.urdf").name().empty(), false);
    } catch (const models::ModelError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

/// What is said of a file, a line each.
std::vector<std::string> Refusals(const std::string& content, const LoadOptions& options = {}) {
  std::vector<std::string> lines;
  try {
    ParseUrdf(Robot(content), "bad.urdf", options, "/nowhere");
  } catch (const models::ModelError& error) {
    std::istringstream text(error.what());
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  }
  return lines;
}

TEST(UrdfRefusalTest, AllErrorsOfAFileAtOnceEachAtItsLine) {
  const std::string two_links = R"(<link name='a'><collision><origin xyz='0 0 nan'/>
<geometry><sphere radius='0'/></geometry></collision></link>
<link name='b'/><link name='b'/>
<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 0'/>
<limit lower='1' upper='0' velocity='1'/></joint>
<joint name='k' type='screw'><child link='b'/></joint>)";
  EXPECT_THAT(Refusals(two_links),
              ElementsAre(AllOf(HasSubstr("bad.urdf:2: link 'a' <origin>: xyz")),
                          AllOf(HasSubstr("bad.urdf:3: link 'a' <sphere>: radius")),
                          AllOf(HasSubstr("bad.urdf:4: link 'b' <link>: name")),
                          AllOf(HasSubstr("bad.urdf:5: joint 'j' <axis>: xyz")),
                          AllOf(HasSubstr("bad.urdf:6: joint 'j' <limit>: range")),
                          AllOf(HasSubstr("bad.urdf:7: joint 'k' <joint>: parent")),
                          AllOf(HasSubstr("bad.urdf:7: joint 'k' <joint>: unsupported joint"))));
}

TEST(UrdfRefusalTest, AllUnknownNamesOfATreeAtOnce) {
  EXPECT_THAT(Refusals(R"(<link name='a'/><link name='b'/>
<joint name='j' type='fixed'><parent link='x'/><child link='b'/></joint>
<joint name='k' type='continuous'><parent link='a'/><child link='y'/><mimic joint='z'/></joint>)"),
              ElementsAre(HasSubstr("bad.urdf:3: joint 'j': unknown parent link; got 'x'"),
                          HasSubstr("bad.urdf:4: joint 'k': unknown child link; got 'y'"),
                          HasSubstr("bad.urdf:4: joint 'k': mimic of an unknown joint; got 'z'")));
}

TEST(UrdfRefusalTest, AllMissingMeshesAtOnceThoseOfALostPackageTogether) {
  const auto mesh = [](const std::string& link, const std::string& file) {
    return "<link name='" + link + "'><collision><geometry><mesh filename='" + file +
           "'/></geometry></collision></link>\n";
  };
  const auto fixed = [](const std::string& child) {
    return "<joint name='to_" + child + "' type='fixed'><parent link='a'/><child link='" + child +
           "'/></joint>\n";
  };
  LoadOptions options;
  options.package_directories = {"/nowhere/packages"};
  const std::string meshes = mesh("a", "package://lost/a.stl") + mesh("b", "here.stl") +
                             mesh("c", "package://lost/c.stl") + mesh("d", "package://gone/d.stl");
  const auto lines = Refusals(meshes + fixed("b") + fixed("c") + fixed("d"), options);
  EXPECT_THAT(
      lines,
      ElementsAre(AllOf(HasSubstr("bad.urdf:3: link 'b' collision: missing mesh file"),
                        HasSubstr("/nowhere/here.stl")),
                  AllOf(HasSubstr("bad.urdf:5: link 'd' collision"), HasSubstr("package 'gone'")),
                  AllOf(HasSubstr("bad.urdf:2: link 'a' collision"), HasSubstr("package 'lost'"),
                        HasSubstr("'package://lost/a.stl', 'package://lost/c.stl' "
                                  "(bad.urdf:4: link 'c' collision)"),
                        HasSubstr("/nowhere/packages/lost"))));
  // Beside other errors too, but not what is only drawn.
  EXPECT_THAT(Refusals(mesh("a", "package://lost/a.stl") + "<link/>"),
              ElementsAre(HasSubstr("bad.urdf:3: <link>: name"), HasSubstr("package 'lost'")));
}

TEST(UrdfRefusalTest, ErrorsWithoutEndAreCounted) {
  std::string content;
  for (int i = 0; i < 60; ++i) content += "<link/>";
  const auto lines = Refusals(content);
  ASSERT_EQ(lines.size(), 51);
  EXPECT_EQ(lines.back(), "and 10 more errors");
}

}  // namespace urdf_refusal_test
}  // namespace oca::robot::test
