// SPDX-License-Identifier: BSD-3-Clause
// Names, refusals and bounds of expressions in xacro files.
#include <gmock/gmock.h>

#include <string>

#include "tests/models/robot/xacro/expressions.h"

namespace oca::robot::test {
namespace xacro_expression_test {

using testing::HasSubstr;
using testing::ThrowsMessage;
using xacro::Mistake;
using xacro::PythonValue;

void ExpectRefused(const std::string& text, const char* why) {
  EXPECT_THAT([&] { ValueOf(text); },
              ThrowsMessage<Mistake>(
                  testing::AllOf(HasSubstr(why), HasSubstr("; got "), HasSubstr("; expected "))))
      << text;
}

TEST(XacroExpressionTest, SeesPropertiesAndTheirAttributes) {
  StubProperties properties;
  properties.values["limits"] = ValueOf("{'lower': -1.5, 'inner': {'x': [1, 2]}, 'items': 4}");
  properties.values["pi"] = PythonValue(3.0);
  EXPECT_EQ(xacro::ToText(ValueOf("limits.lower", properties)), "-1.5");
  EXPECT_EQ(xacro::ToText(ValueOf("limits.inner.x[1]", properties)), "2");
  EXPECT_EQ(xacro::ToText(ValueOf("limits.items", properties)), "4");
  EXPECT_EQ(xacro::ToText(ValueOf("len(limits.items())", properties)), "3");
  EXPECT_EQ(xacro::ToText(ValueOf("pi", properties)), "3.0");
  EXPECT_EQ(xacro::ToText(ValueOf("math.pi", properties)), "3.141592653589793");
  EXPECT_EQ(xacro::ToText(ValueOf("xacro.load_yaml('a.yaml')", properties)), "load_yaml:a.yaml");
  EXPECT_EQ(xacro::ToText(ValueOf("load_yaml('a.yaml')", properties)), "load_yaml:a.yaml");
}

TEST(XacroExpressionTest, DoesNotWorkOutWhatIsNotChosen) {
  EXPECT_EQ(xacro::ToText(ValueOf("1 if True else nothing")), "1");
  EXPECT_EQ(xacro::ToText(ValueOf("0 and nothing")), "0");
  EXPECT_EQ(xacro::ToText(ValueOf("3 or nothing")), "3");
  EXPECT_EQ(xacro::ToText(ValueOf("2 < 1 < nothing")), "False");
}

TEST(XacroExpressionTest, BackslashesMeanWhatTheyMeanToPython) {
  const auto text = [](const std::string& expression) {
    return xacro::ToText(ValueOf(expression));
  };
  EXPECT_EQ(text(R"('\a\b\f\n\r\t\v\\\'\"')"), "\a\b\f\n\r\t\v\\'\"");
  EXPECT_EQ(text(R"('\x41\x7e\xe4')"), "A~\xC3\xA4");
  EXPECT_EQ(text(R"('\u00e4\u20AC\U0001f916')"), "\xC3\xA4\xE2\x82\xAC\xF0\x9F\xA4\x96");
  EXPECT_EQ(text(R"('\101\0601\18\777')"),
            "A01\x01"
            "8\xC7\xBF");
  EXPECT_EQ(text(R"('\0')"), std::string(1, '\0'));
  EXPECT_EQ(text("'a\\\nb'"), "ab");
  EXPECT_EQ(text(R"('\d\8\%')"), R"(\d\8\%)");
  EXPECT_EQ(text(R"(len('\x41\u00e4\n\0'))"), "4");
  EXPECT_EQ(text(R"(repr('\0\r\x1f\x7f'))"), R"('\x00\r\x1f\x7f')");
  ExpectRefused(R"('\x4')", "text; got \\x4");
  ExpectRefused(R"('\xg1')", "2 hexadecimal digits");
  ExpectRefused(R"('\u+123')", "4 hexadecimal digits");
  ExpectRefused(R"('\ud800')", "a character of Unicode");
  ExpectRefused(R"('\U00110000')", "a character of Unicode");
  ExpectRefused(R"('\N{DEGREE SIGN}')", "by its name");
  ExpectRefused(R"('a\')", "without end");
}

TEST(XacroExpressionTest, RefusesWithWhatItKnows) {
  ExpectRefused("", "got nothing");
  ExpectRefused("1 +", "got its end");
  ExpectRefused("1 2", "got 2");
  ExpectRefused("(1", "expected ')'");
  ExpectRefused("'a", "without end");
  ExpectRefused("a = 1", "got =");
  ExpectRefused("1 ? 2", "got '?'");
  ExpectRefused("lambda: 1", "got lambda");
  ExpectRefused("[x for x in [1]]", "got for");
  ExpectRefused("f'{x}'", "text with a prefix");
  ExpectRefused("nothing", "unknown name; got 'nothing'");
  ExpectRefused("open('/etc/passwd')", "unknown function; got 'open'");
  ExpectRefused("__import__('os')", "unknown function; got '__import__'");
  ExpectRefused("''.__class__", "attribute '__class__'");
  ExpectRefused("'a'.encode()", "method of str; got 'encode'; expected one of split");
  ExpectRefused("'a' + 1", "'+'; got str + int");
  ExpectRefused("1 in 2", "'in'");
  ExpectRefused("'a' < 1", "order");
  ExpectRefused("{'a': 1}['b']", "unknown key; got 'b'; expected one of a");
  ExpectRefused("[1][1]", "expected 0 to 0");
  ExpectRefused("[][0]", "place in a list");
  ExpectRefused("1 / 0", "division by 0");
  ExpectRefused("1 % 0", "division by 0");
  ExpectRefused("1.0 // 0.0", "division by 0");
  ExpectRefused("0 ** -1", "negative power");
  ExpectRefused("sqrt(-1)", "sqrt()");
  ExpectRefused("log(0)", "log()");
  ExpectRefused("acos(2)", "acos()");
  ExpectRefused("sin()", "sin(); got 0 arguments; expected 1");
  ExpectRefused("sin(x=1)", "an argument x=");
  ExpectRefused("sin('a')", "expected a number");
  ExpectRefused("int('x')", "int()");
  ExpectRefused("float('x')", "float()");
  ExpectRefused("{[1]: 2}", "key of a dictionary");
  ExpectRefused("012", "leading zeros");
  ExpectRefused("'%d' % 'a'", "a number for %d");
  ExpectRefused("'%s' % (1, 2)", "too many values");
  ExpectRefused("'%s %s' % (1,)", "too few values");
  ExpectRefused("'%n' % 1", "'%'");
  ExpectRefused("'\u00e9'.upper()", "upper()");  // not known here, so not left as it is
  ExpectRefused("'\u00e9'.isalpha()", "expected characters of ASCII");
  ExpectRefused("'a\u00a0'.strip('\u00a0')", "strip()");
}

TEST(XacroExpressionTest, BoundsWhatAStrangerMayAskFor) {
  ExpectRefused("'a' * 10 ** 9", "times");
  ExpectRefused("[0] * 10 ** 9", "times");
  ExpectRefused("9 ** 9 ** 9", "beyond 64 bits");
  ExpectRefused("10.0 ** 400", "beyond those of a double");
  ExpectRefused("9223372036854775807 + 1", "beyond 64 bits");
  ExpectRefused("9223372036854775808", "64 bits");
  ExpectRefused("range(10 ** 8)", "at most 100000 items");
  ExpectRefused("'%999999f' % 1 * 2", "'%'");
  ExpectRefused(std::string(200, '(') + "1" + std::string(200, ')'), "more than 100 levels");
  ExpectRefused(std::string(300, '-') + "1", "expression");
  ExpectRefused(
      "1" +
          [] {
            std::string s;
            for (int i = 0; i < 300; ++i) s += "+1";
            return s;
          }(),
      "more than 100 levels");
  ExpectRefused(std::string(30'000, '1'), "at most 20000");
  PythonValue nested = ValueOf("[1]");
  const auto nest = [&] {
    for (int i = 0; i < 100; ++i) nested = PythonValue::ListOf({nested});
  };
  EXPECT_THAT(nest, ThrowsMessage<Mistake>(HasSubstr("more than 64 levels")));
  // Shared items print far larger than they are.
  PythonValue doubled = ValueOf("[1]");
  for (int i = 0; i < 40; ++i) doubled = PythonValue::ListOf({doubled, doubled});
  EXPECT_THAT([&] { xacro::ToText(doubled); }, ThrowsMessage<Mistake>(HasSubstr("length")));
  EXPECT_THAT([&] { Equal(doubled, doubled); }, ThrowsMessage<Mistake>(HasSubstr("comparison")));
}

TEST(XacroExpressionTest, TakesTheTextOfAPropertyForANumberAsXacroDoes) {
  const auto literal = [](const char* text) {
    const PythonValue value = xacro::LiteralOf(text);
    return std::string(value.type()) + " " + xacro::ToText(value);
  };
  EXPECT_EQ(literal("1"), "int 1");
  EXPECT_EQ(literal("+1"), "int 1");
  EXPECT_EQ(literal("010"), "int 10");
  EXPECT_EQ(literal(" 7 "), "int 7");
  EXPECT_EQ(literal("1.50"), "float 1.5");
  EXPECT_EQ(literal("1e3"), "float 1000.0");
  EXPECT_EQ(literal("true"), "bool True");
  EXPECT_EQ(literal("False"), "bool False");
  EXPECT_EQ(literal("'false'"), "str false");
  EXPECT_EQ(literal("'1'"), "str 1");
  EXPECT_EQ(literal("1_0"), "str 1_0");
  EXPECT_EQ(literal("0 0 1"), "str 0 0 1");
  EXPECT_EQ(literal(""), "str ");
  EXPECT_EQ(literal("12345678901234567890"), "str 12345678901234567890");
}

}  // namespace xacro_expression_test
}  // namespace oca::robot::test
