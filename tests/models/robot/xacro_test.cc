// SPDX-License-Identifier: BSD-3-Clause
// Elements of xacro files. Expected texts follow from what xacro's documentation says of each.
#include <gmock/gmock.h>

#include <string>

#include "tests/models/robot/xacro_fixture.h"

namespace oca::robot::test {
namespace xacro_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using XacroTest = XacroFixture;

TEST_F(XacroTest, WritesWhatIsNoXacroAsItIs) {
  EXPECT_EQ(Expanded("<link name='a&amp;b'><x/>text &lt; 1</link><!-- comment -->"),
            "<link name=\"a&amp;b\"><x/>text &lt; 1</link>");
  EXPECT_THAT(ExpandXacro(Put("m.xacro", "")).urdf,
              AllOf(HasSubstr("<robot name=\"r\"/>"), Not(HasSubstr("xmlns:xacro"))));
}

TEST_F(XacroTest, PutsPropertiesIntoTexts) {
  EXPECT_EQ(Expanded("<xacro:property name='w' value='2.0'/><xacro:property name='n' value='ab'/>"
                     "<a v='${w * 3}' s='${n}_${w}' t='x${1}y' p='${w}'>${n}</a>"),
            "<a v=\"6.0\" s=\"ab_2.0\" t=\"x1y\" p=\"2.0\">ab</a>");
}

TEST_F(XacroTest, KeepsTheTypeOfAnAttributeThatIsOneExpression) {
  EXPECT_EQ(Expanded("<xacro:property name='l' value='${[1, 2]}'/>"
                     "<xacro:property name='one' value='${l[1]}'/>"
                     "<xacro:macro name='m' params='d'><a v='${d[\"k\"] + 1}'/></xacro:macro>"
                     "<xacro:m d='${dict(k=one)}'/>"),
            "<a v=\"3\"/>");
}

TEST_F(XacroTest, LeavesOutOneDollarOfEscapes) {
  EXPECT_EQ(Expanded("<a b='$${x} $$(arg y) $5 $ $$${z}'/>"),
            "<a b=\"${x} $(arg y) $5 $ $${z}\"/>");
}

TEST_F(XacroTest, WorksPropertiesOutWhenTheyAreFirstUsed) {
  EXPECT_EQ(Expanded("<xacro:property name='a' value='${b + 1}'/>"
                     "<xacro:property name='b' value='1'/><x v='${a}'/>"
                     "<xacro:property name='b' value='5'/><x v='${a}'/>"),
            "<x v=\"2\"/><x v=\"2\"/>");
  EXPECT_EQ(Expanded("<xacro:property name='b' value='1'/>"
                     "<xacro:property name='a' value='${b + 1}' lazy_eval='false'/>"
                     "<xacro:property name='b' value='5'/><x v='${a} ${b}'/>"),
            "<x v=\"2 5\"/>");
}

TEST_F(XacroTest, TakesDefaultsForWhatIsNotYetThereAndRemoves) {
  EXPECT_EQ(Expanded("<xacro:property name='a' value='1'/><xacro:property name='a' default='2'/>"
                     "<xacro:property name='b' default='3'/><x v='${a} ${b}'/>"
                     "<xacro:property name='a' remove='true'/>"
                     "<xacro:property name='a' default='4'/><x v='${a}'/>"),
            "<x v=\"1 3\"/><x v=\"4\"/>");
}

TEST_F(XacroTest, ScopesOfPropertiesAreThoseOfCalls) {
  EXPECT_EQ(Expanded("<xacro:property name='a' value='outer'/>"
                     "<xacro:macro name='m' params='p'>"
                     "<xacro:property name='a' value='inner'/>"
                     "<xacro:property name='up' value='${p + 1}' scope='parent'/>"
                     "<xacro:property name='all' value='${p + 2}' scope='global'/>"
                     "<x v='${a}'/></xacro:macro>"
                     "<xacro:macro name='n' params=''><xacro:m p='1'/><x v='${up}'/></xacro:macro>"
                     "<xacro:n/><x v='${a} ${all}'/>"),
            "<x v=\"inner\"/><x v=\"2\"/><x v=\"outer 3\"/>");
  ExpectRefused(
      "<xacro:macro name='m'><xacro:property name='a' value='1'/></xacro:macro>"
      "<xacro:m/>\n<x v='${a}'/>",
      "3: <x>: v: ${a}: unknown name", "got 'a'");
}

TEST_F(XacroTest, InsertsBlocksOfPropertiesAsOftenAsAsked) {
  EXPECT_EQ(Expanded("<xacro:property name='b'><y v='${n}'/><z/></xacro:property>"
                     "<xacro:property name='n' value='1'/><x><xacro:insert_block name='b'/></x>"
                     "<xacro:property name='n' value='2'/><xacro:insert_block name='b'/>"),
            "<x><y v=\"1\"/><z/></x><y v=\"2\"/><z/>");
}

TEST_F(XacroTest, MacrosTakeParametersWithDefaults) {
  const std::string macro =
      "<xacro:macro name='m' params='a b:=2 c=3 d:=\\'x y\\' e:=${b*2} f:=true'>"
      "<x v='${a} ${b} ${c} ${d} ${e} ${f}'/></xacro:macro><xacro:property name='b' value='7'/>";
  std::string quoted = macro;
  for (std::size_t at; (at = quoted.find("\\'")) != std::string::npos;) {
    quoted.replace(at, 2, "&apos;");
  }
  EXPECT_EQ(Expanded(quoted + "<xacro:m a='1'/><xacro:m a='q' b='${1 + 1.0}' d='z'/>"),
            "<x v=\"1 2 3 x y 14 True\"/><x v=\"q 2.0 3 z 14 True\"/>");
}

TEST_F(XacroTest, MacrosTakeOverWhatTheCallerHas) {
  const std::string macro =
      "<xacro:macro name='m' params='a:=^ b:=^|4'><x v='${a} ${b}'/></xacro:macro>";
  EXPECT_EQ(Expanded(macro + "<xacro:property name='a' value='1'/><xacro:m/><xacro:m b='2'/>"
                             "<xacro:property name='b' value='3'/><xacro:m a='0'/>"),
            "<x v=\"1 4\"/><x v=\"1 2\"/><x v=\"0 3\"/>");
  ExpectRefused(macro + "\n<xacro:m/>", "3: <xacro:m>: parameters", "nothing for a");
}

TEST_F(XacroTest, MacrosTakeBlocks) {
  EXPECT_EQ(Expanded("<xacro:macro name='m' params='*one **all n'>"
                     "<a><xacro:insert_block name='one'/></a>"
                     "<b><xacro:insert_block name='all'/></b></xacro:macro>"
                     "<xacro:property name='n' value='outer'/>"
                     "<xacro:m n='inner'><o v='${n}'/><c><p/><q v='$${n}'/></c></xacro:m>"),
            "<a><o v=\"outer\"/></a><b><p/><q v=\"inner\"/></b>");
  const std::string macro = "<xacro:macro name='m' params='*one'></xacro:macro>\n";
  ExpectRefused(macro + "<xacro:m/>", "3: <xacro:m>: blocks", "one for *one");
  ExpectRefused(macro + "<xacro:m><a/><b/></xacro:m>", "3: <xacro:m>: blocks", "<b> too many");
  ExpectRefused("<xacro:insert_block name='q'/>", "2: <xacro:insert_block>: block", "got 'q'");
}

TEST_F(XacroTest, MacrosMayBeDefinedInMacrosAndAnew) {
  EXPECT_EQ(Expanded("<xacro:macro name='m'><xacro:macro name='i' params='v'><x v='${v}'/>"
                     "</xacro:macro><xacro:i v='1'/></xacro:macro><xacro:m/>"
                     "<xacro:macro name='m'><y/></xacro:macro><xacro:m/>"),
            "<x v=\"1\"/><y/>");
  ExpectRefused(
      "<xacro:macro name='m'><xacro:macro name='inner'/></xacro:macro><xacro:m/>\n"
      "<xacro:inner/>",
      "3: <xacro:inner>: unknown macro", "such as 'm'");
}

TEST_F(XacroTest, MacrosRecurUntilAConditionEndsIt) {
  EXPECT_EQ(Expanded("<xacro:macro name='loop' params='i n'><xacro:unless value='${i == n}'>"
                     "<x i='${i}'/><xacro:loop i='${i + 1}' n='${n}'/></xacro:unless>"
                     "</xacro:macro><xacro:loop i='0' n='3'/>"),
            "<x i=\"0\"/><x i=\"1\"/><x i=\"2\"/>");
}

TEST_F(XacroTest, CallsMacrosByAComputedName) {
  EXPECT_EQ(Expanded("<xacro:macro name='m_1' params='v *b'><x v='${v}'/>"
                     "<xacro:insert_block name='b'/></xacro:macro>"
                     "<xacro:call macro='m_${1}' v='2'><y/></xacro:call>"),
            "<x v=\"2\"/><y/>");
  ExpectRefused("<xacro:call macro='none'/>", "2: <xacro:call>: unknown macro", "'none'");
}

TEST_F(XacroTest, ConditionsKeepOrLeaveOutWhatTheyHold) {
  EXPECT_EQ(Expanded("<xacro:property name='t' value='true'/>"
                     "<xacro:if value='${t}'><a/></xacro:if><xacro:unless value='${t}'><b/>"
                     "</xacro:unless><xacro:if value='0'><c v='${nothing}'/></xacro:if>"
                     "<xacro:unless value='false'><d/></xacro:unless>"
                     "<xacro:if value='${[]}'><e/></xacro:if><xacro:if value='${1 &lt; 2}'><f/>"
                     "</xacro:if>"),
            "<a/><d/><f/>");
  ExpectRefused("<xacro:if value='maybe'/>", "2: <xacro:if>: condition", "got 'maybe'");
  ExpectRefused("<xacro:if/>", "2: <xacro:if>: value", "got nothing");
}

TEST_F(XacroTest, NamesElementsAndAttributesByExpressions) {
  EXPECT_EQ(Expanded("<xacro:element xacro:name='${\"li\" + \"nk\"}' name='a'>"
                     "<xacro:attribute name='q' value='${1 + 1}'/><b/></xacro:element>"),
            "<link name=\"a\" q=\"2\"><b/></link>");
}

TEST_F(XacroTest, ArgumentsStandForTheirDefaultsUnlessGiven) {
  const std::string content =
      "<xacro:arg name='a' default='1'/><xacro:arg name='b' default='$(arg a)_x'/>"
      "<xacro:property name='p' value='$(arg a)'/>"
      "<x a='$(arg a)' b='$(arg b)' p='${p + 1}' q='${\"$(arg b)\".upper()}' "
      "r='${xacro.arg(\"b\")}'/>"
      "<xacro:if value='$(arg a)'><y/></xacro:if>";
  EXPECT_EQ(Expanded(content), "<x a=\"1\" b=\"1_x\" p=\"2\" q=\"1_X\" r=\"1_x\"/><y/>");
  options.arguments = {{"a", "0"}};
  EXPECT_EQ(Expanded(content), "<x a=\"0\" b=\"0_x\" p=\"1\" q=\"0_X\" r=\"0_x\"/>");
  options.arguments = {{"aa", "0"}};
  ExpectRefused(content, "1: <robot>: unknown argument", "one of the file such as 'a'");
  options.arguments = {};
  ExpectRefused("<x v='$(arg q)'/>", "2: <x>: v: argument", "'q', which has no value here");
  ExpectRefused("<xacro:arg name='q'/>", "2: <xacro:arg>: argument 'q'", "neither");
}

TEST_F(XacroTest, NamesTheRobotByAnArgumentOfFurtherBelow) {
  const auto file = folder.Write("n.xacro",
                                 "<robot name='$(arg name)' xmlns:xacro='x'>"
                                 "<xacro:arg name='name' default='ur'/></robot>");
  EXPECT_THAT(ExpandXacro(file).urdf, HasSubstr("<robot name=\"ur\"/>"));
}

TEST_F(XacroTest, EvaluatesListsThatArgumentsSpellOut) {
  EXPECT_EQ(Expanded("<xacro:arg name='ids' default=\"['a','b']\"/>"
                     "<xacro:property name='list' value='${$(arg ids)}'/><x v='${list[1]}'/>"),
            "<x v=\"b\"/>");
}

}  // namespace xacro_test
}  // namespace oca::robot::test
