// SPDX-License-Identifier: BSD-3-Clause
// What xacro files read, where their mistakes are told, and what they may take.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/xacro_fixture.h"

namespace oca::robot::test {
namespace xacro_files_test {

using models::ModelError;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

using XacroFilesTest = XacroFixture;

TEST_F(XacroFilesTest, IncludesFilesRelativeToTheFileThatAsks) {
  Put("inc/a.xacro", "<xacro:include filename='deep/b.xacro'/><a/>");
  Put("inc/deep/b.xacro", "<xacro:property name='w' value='3'/><b d='$(dirname)'/>");
  EXPECT_EQ(Expanded("<xacro:include filename='inc/a.xacro'/><x v='${w}'/>"),
            "<b d=\"" + (folder.path() / "inc/deep").string() + "\"/><a/><x v=\"3\"/>");
  EXPECT_EQ(Expanded("<xacro:include filename='none.xacro' optional='true'/><x/>"), "<x/>");
  ExpectRefused("\n<xacro:include filename='none.xacro'/>", "3: <xacro:include>", "none.xacro");
}

TEST_F(XacroFilesTest, IncludesFromMacrosRelativeToTheirFile) {
  Put("lib/macros.xacro",
      "<xacro:macro name='m'><xacro:include filename='part.xacro'/></xacro:macro>");
  Put("lib/part.xacro", "<part/>");
  EXPECT_EQ(Expanded("<xacro:include filename='lib/macros.xacro'/><xacro:m/>"), "<part/>");
}

TEST_F(XacroFilesTest, FindsPackagesWhereOptionsSay) {
  Put("packages/arm_description/urdf/arm.xacro", "<arm/>");
  options.package_directories = {folder.path() / "none", folder.path() / "packages"};
  const std::string content = "<xacro:include filename='$(find arm_description)/urdf/arm.xacro'/>";
  EXPECT_EQ(Expanded(content), "<arm/>");
  EXPECT_EQ(Expanded("<xacro:include filename='package://arm_description/urdf/arm.xacro'/>"),
            "<arm/>");
  EXPECT_EQ(Expanded("<xacro:property name='p' value='arm'/>"
                     "<xacro:include filename='$(find ${p}_description)/urdf/arm.xacro'/>"),
            "<arm/>");
  Put("other/urdf/arm.xacro", "<other/>");
  options.find_package = [&](const std::string& package) {
    return package == "arm_description" ? folder.path() / "other" : std::filesystem::path();
  };
  EXPECT_EQ(Expanded(content), "<other/>");
  ExpectRefused("<xacro:include filename='$(find nowhere)/a.xacro'/>", "2: <xacro:include>",
                "package; got 'nowhere'");
}

TEST_F(XacroFilesTest, KeepsNamespacesOfIncludesApart) {
  Put("lib.xacro",
      "<xacro:property name='w' value='5'/><xacro:property name='d' value='${w + 1}'/>"
      "<xacro:macro name='m' params='p'><x v='${p} ${w}'/></xacro:macro>");
  EXPECT_EQ(Expanded("<xacro:property name='w' value='1'/>"
                     "<xacro:include filename='lib.xacro' ns='lib'/>"
                     "<x v='${w} ${lib.w} ${lib.d}'/><xacro:lib.m p='${w}'/>"),
            "<x v=\"1 5 6\"/><x v=\"1 5\"/>");
  ExpectRefused("<xacro:include filename='lib.xacro' ns='lib'/>\n<xacro:m p='1'/>",
                "3: <xacro:m>: unknown macro", "such as 'lib.m'");
  ExpectRefused("<xacro:include filename='lib.xacro' ns='lib'/>\n<x v='${lib.q}'/>", "3: <x>",
                "unknown name in a namespace; got 'q'");
}

TEST_F(XacroFilesTest, GivesTheEnvironmentNoSay) {
  setenv("OCA_XACRO_TEST", "secret", 1);
  EXPECT_EQ(Expanded("<x v='$(optenv OCA_XACRO_TEST a b)' w='$(optenv OCA_XACRO_TEST)'/>"),
            "<x v=\"a b\" w=\"\"/>");
  ExpectRefused("<x v='$(env OCA_XACRO_TEST)'/>", "2: <x>: v: substitution; got $(env ",
                "the environment has no say");
  ExpectRefused("<x v='$(cwd)'/>", "2: <x>", "substitution");
  ExpectRefused("<x v='$(eval 1)'/>", "2: <x>", "substitution");
  ExpectRefused("<x v='$(q)'/>", "2: <x>", "substitution; got $(q)");
  unsetenv("OCA_XACRO_TEST");
}

TEST_F(XacroFilesTest, LoadsYamlWithUnits) {
  folder.Write("config/limits.yaml",
               "limits:\n  pan: {max: !degrees 180.0, min: !radians -pi / 2, rate: 2}\n"
               "lengths: [!millimeters 5, !inches 1, !foot 1, !meters 2]\n"
               "plain: {t: 1e3, b: yes, n: null, s: '1', f: 1.5e+3, o: 010, h: 0x1f}\n"
               "base: &b {a: 1, c: 2}\nderived: {<<: *b, c: 3}\n");
  EXPECT_EQ(
      Expanded(
          "<xacro:property name='c' value=\"${xacro.load_yaml('config/limits.yaml')}\"/>"
          "<x a=\"${c['limits']['pan']['max']}\" b='${c.limits.pan.min}' r='${c.limits.pan.rate}'"
          " l='${c.lengths}' p='${c.plain}' d='${c.derived}'/>"),
      "<x a=\"3.141592653589793\" b=\"-1.5707963267948966\" r=\"2\" l=\"[0.005, 0.0254, 0.3048, "
      "2.0]\" p=\"{'t': '1e3', 'b': True, 'n': None, 's': '1', 'f': 1500.0, 'o': 8, 'h': 31}\" "
      "d=\"{'a': 1, 'c': 3}\"/>");
  folder.Write("bad.yaml", "a: 1\nb: !tons 3\n");
  ExpectRefused("<x v=\"${load_yaml('bad.yaml')}\"/>", "2: <x>", "bad.yaml:2: tag; got '!tons'");
  ExpectRefused("<x v=\"${load_yaml('none.yaml')}\"/>", "2: <x>", "none.yaml");
  folder.Write("key.yaml", "a: {b: 1}\n");
  ExpectRefused("<x v=\"${load_yaml('key.yaml')['a']['q']}\"/>", "2: <x>",
                "unknown key; got 'q'; expected one of b");
}

// Values by PyYAML 6.0, yaml.safe_load.
TEST_F(XacroFilesTest, PlainScalarsOfYamlAreThoseOfPyYaml) {
  folder.Write("y.yaml",
               "[1:30, -1:30, 190:20:30, 1:30.5, +0:1.25, 0b11, -0b1_1, 0x1F, 1_000, 010, 0_7, 00, "
               "-0, .5, 5., 1_0.5, 6.8523015e+5, 9223372036854775807]");
  EXPECT_EQ(Expanded("<x v=\"${load_yaml('y.yaml')}\"/>"),
            "<x v=\"[90, -90, 685230, 90.5, 1.25, 3, -3, 31, 1000, 8, 7, 0, 0, 0.5, 5.0, 10.5, "
            "685230.15, 9223372036854775807]\"/>");
  folder.Write("t.yaml", "[0o17, -.5, 1e3, 1:60, 01:30, 08, 1.5e3, 0x, 1.2.3, '1:30', 2001-1-1]");
  EXPECT_EQ(Expanded("<x v=\"${load_yaml('t.yaml')}\"/>"),
            "<x v=\"['0o17', '-.5', '1e3', '1:60', '01:30', '08', '1.5e3', '0x', "
            "'1.2.3', '1:30', '2001-1-1']\"/>");
  for (const char* const scalar :
       {"2001-12-14", "2001-12-14t21:59:43.10-05:00", "=", "9223372036854775808",
        "153722867280912931:00", "0xFFFFFFFFFFFFFFFF"}) {
    folder.Write("r.yaml", "a: 1\nb: " + std::string(scalar) + "\n");
    ExpectRefused("<x v=\"${load_yaml('r.yaml')}\"/>", "2: <x>", "r.yaml:2: ");
  }
}

TEST_F(XacroFilesTest, NamesOfElementsAndAttributesAreThoseOfXml) {
  EXPECT_EQ(Expanded("<xacro:element xacro:name='${\"a\" + \"-1.b:c\"}'><xacro:attribute name='_x' "
                     "value='1'/></xacro:element>"),
            "<a-1.b:c _x=\"1\"/>");
  EXPECT_EQ(Expanded("<xacro:element xacro:name='\xC3\xA4'/>"), "<\xC3\xA4/>");
  for (const char* const name : {"", "a b", "a&gt;&lt;x", "1", "-a", "a=", "a&quot;", "\xC3\x97"}) {
    ExpectRefused("\n<xacro:element xacro:name='" + std::string(name) + "'/>",
                  "3: <xacro:element>: xacro:name; got '", "expected a name of XML");
    ExpectRefused("<x>\n<xacro:attribute name='" + std::string(name) + "' value='1'/></x>",
                  "3: <xacro:attribute>: name; got '", "expected a name of XML");
  }
}

TEST_F(XacroFilesTest, WhatXmlCannotHoldIsRefusedWithItsPlace) {
  ExpectRefused(R"(<x v="${'a\0'}"/>)",
                "2: ", R"(text; got 'a\x00'; expected characters that XML)");
  ExpectRefused(R"(<x>${'\x01'}</x>)", "2: ", R"(got '\x01')");
  EXPECT_EQ(Expanded(R"(<x v="${'\x41\t\u00e4'}"/>)"), "<x v=\"A\t\xC3\xA4\"/>");
}

TEST_F(XacroFilesTest, TellsWhatTheFileHasToSay) {
  std::vector<std::string> lines;
  options.warn = [&](const std::string& line) { lines.push_back(line); };
  EXPECT_EQ(Expanded("<x v='${xacro.warning(\"no inertia of\", 3)}'/>"), "<x v=\"\"/>");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], AllOf(HasSubstr("main.xacro:2: no inertia of 3")));
  ExpectRefused("<x>${xacro.fatal('unknown arm')}</x>", "2: text in <x>", "got unknown arm");
}

TEST_F(XacroFilesTest, NamesTheLineAndTheCallsOfEveryMistake) {
  Put("lib.xacro", "<xacro:macro name='m' params='p'>\n<x v='${q}'/></xacro:macro>");
  const std::string file =
      Put("main.xacro",
          "<xacro:include filename='lib.xacro'/>\n"
          "<xacro:macro name='outer'><xacro:m p='1'/></xacro:macro>\n<xacro:outer/>");
  EXPECT_THAT([&] { ExpandXacro(file); },
              ThrowsMessage<ModelError>(
                  AllOf(HasSubstr("lib.xacro:3 (called at "), HasSubstr("main.xacro:3, "),
                        HasSubstr("main.xacro:4): <x>: v: ${q}: unknown name; got 'q'"))));
  ExpectRefused("<xacro:property name='a' value='${b}'/>\n<x v='${a}'/>", "3: <x>: v: ${a}: ${b}",
                "(of property 'a', ");
  ExpectRefused("<xacro:propery name='a'/>", "2: <xacro:propery>", "unknown macro");
  ExpectRefused("<xacro:property name='a' valu='1'/>", "2: <xacro:property>",
                "unknown attribute; got 'valu'");
  ExpectRefused("<xacro:property name='1a' value='1'/>", "2: <xacro:property>", "name; got '1a'");
  ExpectRefused("<xacro:property name='a' value='1' default='2'/>", "2: <xacro:property>",
                "several");
  ExpectRefused("<xacro:macro name='a.b'/>", "2: <xacro:macro>", "name; got 'a.b'");
  ExpectRefused("<xacro:macro name='a' params='1b'/>", "2: <xacro:macro>", "parameter of a macro");
  ExpectRefused("<xacro:macro name='a' params='b'/>\n<xacro:a c='1'/>", "3: <xacro:a>",
                "unknown parameter; got 'c'; expected one of b");
  ExpectRefused("<x v='${1'/>", "2: <x>: v: expression; got '${1' without end", "closing }");
}

TEST_F(XacroFilesTest, NamesThePlaceInTheXacroOfWhatTheUrdfGetsWrong) {
  Put("lib.xacro",
      "<xacro:macro name='arm' params='r'>\n<link name='a'><collision><geometry>\n"
      "<sphere radius='${r}'/></geometry></collision></link></xacro:macro>");
  const std::string file =
      Put("arm.urdf.xacro", "<xacro:include filename='lib.xacro'/>\n<xacro:arm r='${-1}'/>");
  EXPECT_THAT([&] { LoadUrdf(file); },
              ThrowsMessage<ModelError>(
                  AllOf(HasSubstr("lib.xacro:4 (called at "), HasSubstr("arm.urdf.xacro:3): "),
                        HasSubstr("link 'a' <sphere>: radius; got '-1'; expected more than 0"))));
  const std::string fine =
      Put("fine.urdf.xacro", "<xacro:include filename='lib.xacro'/>\n<xacro:arm r='0.1'/>");
  const RobotModel robot = LoadUrdf(fine);
  EXPECT_THAT(robot.links()[0].collisions[0].source, HasSubstr("lib.xacro:3 (called at "));
  LoadOptions given;
  given.xacro_arguments = {{"a", "1"}};
  EXPECT_THAT([&] { LoadUrdf(folder.Write("plain.urdf", "<robot name='r'/>"), given); },
              ThrowsMessage<ModelError>(HasSubstr("arguments; got 'a'; expected none")));
}

TEST_F(XacroFilesTest, NotesEveryFileThatItOpens) {
  Put("lib.xacro", "");
  folder.Write("c.yaml", "a: 1");
  const std::string file = Put("main.xacro",
                               "<xacro:include filename='lib.xacro'/>"
                               "<x v=\"${load_yaml('c.yaml').a}\"/>");
  const models::OpenedFiles opened;
  ExpandXacro(file);
  EXPECT_THAT(opened.files(), ElementsAre(folder.path() / "main.xacro", folder.path() / "lib.xacro",
                                          folder.path() / "c.yaml"));
}

TEST_F(XacroFilesTest, BoundsWhatAStrangerMayAskFor) {
  ExpectRefused("<xacro:macro name='m'><xacro:m/></xacro:macro><xacro:m/>", "2 (called at ",
                "nesting; got more than 500 levels");
  ExpectRefused("<xacro:include filename='main.xacro'/>", "2: <xacro:include>", "nesting");
  ExpectRefused(
      "<xacro:property name='a' value='${b}'/><xacro:property name='b' value='${a}'/>"
      "<x v='${a}'/>",
      "2: <x>: v: ${a}", "property 'a'; got a value that uses itself");
  std::string doubling = "<xacro:macro name='m0'><x/></xacro:macro>";
  for (int i = 1; i <= 30; ++i) {
    const std::string call = "<xacro:m" + std::to_string(i - 1) + "/>";
    doubling += "<xacro:macro name='m" + std::to_string(i) + "'>" + call + call + "</xacro:macro>";
  }
  ExpectRefused(doubling + "<xacro:m30/>", "2 (called at ", "more than 200000 elements");
  std::string texts = "<xacro:property name='a0' value='0123456789'/>";
  for (int i = 1; i <= 40; ++i) {
    const std::string before = "${a" + std::to_string(i - 1) + "}";
    texts += "<xacro:property name='a" + std::to_string(i) + "' value='" + before + before + "'/>";
  }
  ExpectRefused(texts + "<x v='${a40}'/>", "2: <x>", "length of a text");
  ExpectRefused(
      "<xacro:property name='t' value='${\"x\" * 1000000}'/>"
      "<xacro:macro name='m'><x v='${t}' w='${t + \"\"}'/><xacro:m/></xacro:macro><xacro:m/>",
      "2 (called at ", "more than");
}

TEST_F(XacroFilesTest, RefusesFilesThatAreNoXml) {
  const auto broken = folder.Write("b.xacro", "<robot><link></robot>");
  EXPECT_THAT([&] { ExpandXacro(broken); }, ThrowsMessage<ModelError>(HasSubstr("b.xacro:1: XML")));
  EXPECT_THAT([&] { ExpandXacro(folder.path() / "none.xacro"); },
              ThrowsMessage<ModelError>(HasSubstr("none.xacro: cannot be read")));
}

}  // namespace xacro_files_test
}  // namespace oca::robot::test
