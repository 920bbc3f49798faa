// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/expression.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oca/diagrams/files/arithmetic.h"
#include "oca/framework/dataflow/error_base.h"
#include "tests/diagrams/files/yaml_text.h"

namespace oca::files {
namespace expression_test {

using testing::HasSubstr;

/// A document with `parameters`, and one text resolved with them.
class Resolved {
 public:
  Resolved(const std::string& parameters, const std::string& text)
      : document_("parameters: " + parameters + "\n") {
    EXPECT_EQ(document_.problems, "");
    Problems found;
    Expressions expressions(At(document_.value, "parameters"), found);
    value = expressions.Resolve(Value(text, Location()));
    for (const Diagnostic& problem : found.all()) problems += problem.ToString() + "\n";
  }
  Value value;
  std::string problems;

 private:
  YamlText document_;
};

double NumberOf(const std::string& text,
                const std::string& parameters = "{a: 2, b: 5, yes_: true}") {
  const Resolved resolved(parameters, text);
  EXPECT_EQ(resolved.problems, "") << text;
  return Number(resolved.value);
}

std::string TextOf(const std::string& text, const std::string& parameters) {
  const Resolved resolved(parameters, text);
  EXPECT_EQ(resolved.problems, "") << text;
  return resolved.value.string() == nullptr ? "no text" : *resolved.value.string();
}

std::string BooleanOf(const std::string& text,
                      const std::string& parameters = "{a: 2, b: 5, on_: true, off_: false}") {
  const Resolved resolved(parameters, text);
  EXPECT_EQ(resolved.problems, "") << text;
  if (resolved.value.boolean() == nullptr) return "no boolean";
  return *resolved.value.boolean() ? "true" : "false";
}

std::string ProblemOf(const std::string& text, const std::string& parameters = "{a: 2}") {
  return Resolved(parameters, text).problems;
}

TEST(ExpressionTest, AWholeNameTakesTypeAndValueOfTheParameter) {
  const std::string parameters = "{n: 3, r: 2.5, t: true, s: hello, l: [1, x], m: {k: 7}}";
  EXPECT_EQ(*Resolved(parameters, "${n}").value.integer(), 3);
  EXPECT_EQ(Number(Resolved(parameters, "${ r }").value), 2.5);
  EXPECT_TRUE(*Resolved(parameters, "${t}").value.boolean());
  EXPECT_EQ(*Resolved(parameters, "${s}").value.string(), "hello");
  const Value list = Resolved(parameters, "${l}").value;
  ASSERT_NE(list.list(), nullptr);
  EXPECT_EQ(*list.list()->at(0).integer(), 1);
  EXPECT_EQ(*list.list()->at(1).string(), "x");
  EXPECT_EQ(*At(Resolved(parameters, "${m}").value, "k").integer(), 7);
  EXPECT_EQ(*Resolved("{s: '12'}", "${s}").value.string(), "12");
}

TEST(ExpressionTest, TextWithoutExpressionsIsLeftAlone) {
  for (const char* text : {"plain", "", "$", "{a}", "$a", "a } b", "100 $"}) {
    EXPECT_EQ(TextOf(text, "{a: 1}"), text);
  }
}

TEST(ExpressionTest, ReplacesExpressionsInListsAndMaps) {
  const YamlText document("parameters: {a: 2}\nx: [\"${a}\", {y: \"${a + 1}\"}]\n");
  Problems problems;
  Expressions expressions(At(document.value, "parameters"), problems);
  const Value x = expressions.Resolve(At(document.value, "x"));
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(*x.list()->at(0).integer(), 2);
  EXPECT_EQ(Number(At(x.list()->at(1), "y")), 3.0);
  EXPECT_EQ(x.list()->at(0).location().ToString(), "f.yaml:2:5");
}

TEST(ExpressionTest, ComputesWithTheUsualPrecedence) {
  EXPECT_EQ(NumberOf("${1 + 2 * 3}"), 7.0);
  EXPECT_EQ(NumberOf("${(1 + 2) * 3}"), 9.0);
  EXPECT_EQ(NumberOf("${10 - 4 - 3}"), 3.0);
  EXPECT_EQ(NumberOf("${2 ^ 3 ^ 2}"), 512.0);
  EXPECT_EQ(NumberOf("${-2 ^ 2}"), -4.0);
  EXPECT_EQ(NumberOf("${8 / 4 / 2}"), 1.0);
  EXPECT_EQ(NumberOf("${a * b - 1}"), 9.0);
  EXPECT_EQ(NumberOf("${-a}"), -2.0);
  EXPECT_EQ(NumberOf("${1e3 + 2.5e-1}"), 1000.25);
  EXPECT_EQ(NumberOf("${1/60}"), 1.0 / 60.0);
}

TEST(ExpressionTest, KnowsPiDegreesAndFunctions) {
  EXPECT_EQ(NumberOf("${pi}"), std::numbers::pi);
  EXPECT_EQ(NumberOf("${deg}"), std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(NumberOf("${180 * deg}"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(NumberOf("${cos(60 * deg)}"), 0.5);
  EXPECT_EQ(NumberOf("${max(a, b, 3)}"), 5.0);
  EXPECT_EQ(NumberOf("${min(a, b)}"), 2.0);
  EXPECT_EQ(NumberOf("${sqrt(a + 7)}"), 3.0);
  EXPECT_EQ(NumberOf("${abs(-a)}"), 2.0);
}

TEST(ExpressionTest, ComparisonsAndLogicGiveBooleans) {
  EXPECT_EQ(BooleanOf("${a < b}"), "true");
  EXPECT_EQ(BooleanOf("${a >= b}"), "false");
  EXPECT_EQ(BooleanOf("${a == 2}"), "true");
  EXPECT_EQ(BooleanOf("${a != 2}"), "false");
  EXPECT_EQ(BooleanOf("${!on_}"), "false");
  EXPECT_EQ(BooleanOf("${!off_ && a < b}"), "true");
  EXPECT_EQ(BooleanOf("${on_ || off_}"), "true");
  EXPECT_EQ(BooleanOf("${(a < b)}"), "true");
  EXPECT_EQ(BooleanOf("${((on_))}"), "true");
  EXPECT_EQ(BooleanOf("${true}"), "true");
  EXPECT_EQ(BooleanOf("${on_ && true}"), "true");
}

TEST(ExpressionTest, NumbersMadeFromComparisonsStayNumbers) {
  EXPECT_EQ(NumberOf("${2 * (a < b)}"), 2.0);
  EXPECT_EQ(NumberOf("${(a < b) * (b + 2)}"), 7.0);
  EXPECT_EQ(NumberOf("${(a > b ? 1 : 3)}"), 3.0);
  EXPECT_EQ(NumberOf("${(a > b ? 1 : 3) + 1}"), 4.0);
  EXPECT_EQ(NumberOf("${a < b ? 4 : 5}"), 4.0);
}

TEST(ExpressionTest, ATernaryChoosesTextNumberOrParameter) {
  const std::string parameters = "{c: true, n: 0, s: word, l: [1, 2]}";
  EXPECT_EQ(TextOf("${c ? 'a' : 'b'}", parameters), "a");
  EXPECT_EQ(TextOf("${!c ? 'a' : 'b'}", parameters), "b");
  EXPECT_EQ(TextOf("${n ? 'a' : 'b: ?'}", parameters), "b: ?");
  EXPECT_EQ(TextOf("${c ? s : 'b'}", parameters), "word");
  EXPECT_EQ(TextOf("${(c ? 'a' : 'b')}", parameters), "a");
  EXPECT_EQ(Resolved(parameters, "${c ? l : s}").value.list()->size(), 2u);
  EXPECT_EQ(NumberOf("${c ? 1 + 1 : 1 / n}", parameters), 2.0);
  EXPECT_EQ(BooleanOf("${c ? n == 0 : false}", parameters), "true");
}

TEST(ExpressionTest, TernariesNestOnBothSides) {
  for (const auto& [a, b, expected] :
       {std::tuple{"true", "true", "x"}, std::tuple{"true", "false", "y"},
        std::tuple{"false", "true", "z"}}) {
    const std::string parameters = std::string("{a: ") + a + ", b: " + b + "}";
    EXPECT_EQ(TextOf("${a ? b ? 'x' : 'y' : 'z'}", parameters), expected);
    EXPECT_EQ(TextOf("${a ? (b ? 'x' : 'y') : 'z'}", parameters), expected);
    EXPECT_EQ(TextOf("${!a ? 'z' : b ? 'x' : 'y'}", parameters), expected);
  }
}

TEST(ExpressionTest, WritesValuesIntoLongerText) {
  EXPECT_EQ(TextOf("link_${n}", "{n: 3}"), "link_3");
  EXPECT_EQ(TextOf("link_${n + 1}_${s}", "{n: 3, s: tip}"), "link_4_tip");
  EXPECT_EQ(TextOf("${n}${n}", "{n: 3}"), "33");
  EXPECT_EQ(TextOf("is ${t}", "{t: true}"), "is true");
  EXPECT_EQ(TextOf("${x} m", "{x: 0.25}"), "0.25 m");
  EXPECT_THAT(ProblemOf("x ${l}", "{l: [1]}"), HasSubstr("a list or map inside a text"));
}

TEST(ExpressionTest, ParametersUseOneAnotherInAnyOrder) {
  EXPECT_EQ(NumberOf("${z}", "{z: '${m * 2}', m: '${a + 1}', a: 3}"), 8.0);
  EXPECT_EQ(TextOf("${file}", "{file: '${name}.csv', name: path}"), "path.csv");
  EXPECT_EQ(Number(Resolved("{l: ['${a}', 1], a: 3}", "${l}").value.list()->at(0)), 3.0);
}

TEST(ExpressionTest, CirclesAreRefusedByName) {
  EXPECT_THAT(ProblemOf("x", "{a: '${a}'}"), HasSubstr("parameters.a: defined by itself"));
  EXPECT_THAT(ProblemOf("x", "{a: '${b + 1}', b: '${c}', c: '${a}'}"),
              HasSubstr("defined by itself"));
  EXPECT_THAT(ProblemOf("x", "{a: ['${a}']}"), HasSubstr("defined by itself"));
}

TEST(ExpressionTest, AChainOfParametersMayBeLongButNotEndless) {
  const auto chain = [](int length) {
    std::string parameters = "{a0: 1";
    for (int i = 1; i < length; ++i) {
      parameters += ", a" + std::to_string(i) + ": '${a" + std::to_string(i - 1) + " + 1}'";
    }
    return parameters + ", 'last': '${a" + std::to_string(length - 1) + "}'}";
  };
  EXPECT_EQ(NumberOf("${last}", chain(20)), 20.0);
  std::string backwards = "{a0000: '${a0001}'";
  for (int i = 1; i < 4000; ++i) {
    backwards += fmt::format(", a{:04}: '${{a{:04} + 1}}'", i, i + 1);
  }
  EXPECT_THAT(ProblemOf("x", backwards + ", a4000: 1}"), HasSubstr("defined through more than"));
}

TEST(ExpressionTest, UnknownNamesAreAnsweredWithTheNearest) {
  EXPECT_THAT(ProblemOf("${rat}", "{rate: 2}"),
              HasSubstr("unknown parameter 'rat'; did you mean 'rate'?"));
  EXPECT_THAT(ProblemOf("${1 / rat}", "{rate: 2}"),
              HasSubstr("unknown parameter 'rat'; did you mean 'rate'?"));
  EXPECT_THAT(ProblemOf("${dge * 3}"), HasSubstr("did you mean 'deg'?"));
  EXPECT_THAT(ProblemOf("${sqr(2)}"), HasSubstr("sqr"));
  EXPECT_THAT(ProblemOf("${completely_different}", "{rate: 2}"),
              testing::Not(HasSubstr("did you mean")));
}

TEST(ExpressionTest, ResultsThatAreNotFiniteAreRefused) {
  for (const char* text : {"${1 / 0}", "${0 / 0}", "${1e308 * 10}", "${sqrt(-1)}", "${ln(0)}"}) {
    EXPECT_THAT(ProblemOf(text), HasSubstr("not finite")) << text;
  }
}

TEST(ExpressionTest, AResultThatIsNotFiniteIsToldOnceWithWhatItComesFrom) {
  const YamlText document(
      "parameters: {rate: 0, reach: 2}\nx: [\"${reach / rate}\", \"${reach / rate}\"]\n");
  Problems problems;
  Expressions expressions(At(document.value, "parameters"), problems);
  expressions.Resolve(At(document.value, "x"));
  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_THAT(problems.all().front().ToString(),
              HasSubstr("f.yaml:2:5: error: ${reach / rate}: the result is not finite; rate is 0 "
                        "(f.yaml:1:20); reach is 2 (f.yaml:1:30)"));
}

TEST(ExpressionTest, TextsAreComparedWhole) {
  const std::string parameters = "{method: report, other: \"${method}\", speed: 3}";
  for (const char* text :
       {"${method == 'report'}", "${'report' == method}", "${method != 'reports'}",
        "${other=='report' ? true : false}", "${(method == 'report')}", "${'a' != 'b'}"}) {
    const Resolved resolved(parameters, text);
    EXPECT_EQ(resolved.problems, "") << text;
    ASSERT_NE(resolved.value.boolean(), nullptr) << text;
    EXPECT_TRUE(*resolved.value.boolean()) << text;
  }
  EXPECT_EQ(NumberOf("${method == 'relaxed' ? 1 : 2}", parameters), 2.0);
  EXPECT_THAT(ProblemOf("${speed == 'report'}", parameters), HasSubstr("got 3; expected a text"));
  EXPECT_THAT(ProblemOf("${spede == 'report'}", parameters), HasSubstr("did you mean 'speed'?"));
}

TEST(ExpressionTest, WhatIsNoExpressionIsRefused) {
  for (const char* text :
       {"${", "${a", "${a + ", "${}", "${ }", "${(a}", "${a)}", "${a b}", "${a ? 1}", "${'a}",
        "${a; b}", "${a = 3}", "${1 ++ }", "${\xff}", "${max()}"}) {
    EXPECT_NE(ProblemOf(text), "") << text;
  }
  EXPECT_THAT(ProblemOf("${a"), HasSubstr("expected a closing }"));
  EXPECT_THAT(ProblemOf("${a ? 1}"), HasSubstr("'?' without ':'"));
}

TEST(ExpressionTest, ADecimalCommaIsNotTakenForALastArgument) {
  EXPECT_THAT(ProblemOf("${0,5}"), HasSubstr("got 2 values; expected one"));
  EXPECT_THAT(ProblemOf("${a, a}"), HasSubstr("got 2 values; expected one"));
}

TEST(ExpressionTest, TextDoesNotCompute) {
  EXPECT_THAT(ProblemOf("${s + 1}", "{s: word}"), HasSubstr("'s' is 'word'; expected a number"));
  EXPECT_THAT(ProblemOf("${l * 2}", "{l: [1]}"), HasSubstr("expected a number"));
  EXPECT_THAT(ProblemOf("${s ? 1 : 2}", "{s: word}"), HasSubstr("expected a condition"));
}

TEST(ExpressionTest, NamesThatMeanSomethingElseAreNoParameters) {
  for (const char* parameters : {"{pi: 3}", "{deg: 1}", "{true: 1}", "{false: 1}", "{max: 1}",
                                 "{sin: 2}", "{'a b': 1}", "{2a: 1}", "{'': 1}", "{a.b: 1}"}) {
    EXPECT_THAT(ProblemOf("x", parameters), HasSubstr("not a free name")) << parameters;
  }
}

TEST(ExpressionTest, HugeExpressionsAreRefusedQuickly) {
  EXPECT_THAT(ProblemOf("${" + std::string(1001, '1') + "}"), HasSubstr("too long"));
  EXPECT_NE(ProblemOf("${" + std::string(900, '(') + "}"), "");
  EXPECT_NE(ProblemOf("${" + std::string(1000000, '(') + "}"), "");
  std::string ternaries;
  for (int i = 0; i < 60; ++i) ternaries += "a ? 1 : ";
  EXPECT_NE(ProblemOf("${" + ternaries + "}", "{a: false}"), "");
  EXPECT_EQ(NumberOf("${" + std::string(20, '(') + "1" + std::string(20, ')') + "}"), 1.0);
}

TEST(ExpressionTest, AProblemIsToldWhereTheExpressionStands) {
  const YamlText document("parameters: {a: 2}\nx:\n  - ${unknown}\n  - 3\n");
  Problems problems;
  Expressions expressions(At(document.value, "parameters"), problems);
  expressions.Resolve(document.value);
  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_THAT(problems.all().front().ToString(), HasSubstr("f.yaml:3:5: error: "));
}

TEST(ExpressionTest, ParametersThatMultiplyOneAnotherAreRefusedQuickly) {
  for (const bool list : {true, false}) {
    std::string parameters = list ? "{a0: [1, 1]" : "{a0: xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx";
    for (int i = 1; i < 30; ++i) {
      const std::string use =
          list ? fmt::format("\"${{a{}}}\"", i - 1) : fmt::format("${{a{}}}", i - 1);
      parameters += list ? fmt::format(", a{}: [{}, {}]", i, use, use)
                         : fmt::format(", a{}: \"{}{}\"", i, use, use);
    }
    EXPECT_THAT(ProblemOf("${a29}", parameters + "}"), HasSubstr("more than 100000 values"));
  }
}

TEST(ExpressionTest, AParameterThatNothingUsesIsNamedWithItsNearest) {
  YamlText document("parameters: {reach: 1, raech: 2, twice: \"${2 * reach}\"}\n");
  Problems problems;
  Expressions expressions(At(document.value, "parameters"), problems);
  expressions.Resolve(Value(std::string("${twice}"), Location()));
  ASSERT_EQ(expressions.Unused().size(), 1u);
  EXPECT_THAT(expressions.Unused()[0].ToString(),
              HasSubstr("parameters.raech: nothing uses it; did you mean 'reach'?"));
  EXPECT_THAT(expressions.Unused({"raech"}), testing::IsEmpty());
  EXPECT_EQ(expressions.Unused({"raeching"}).size(), 1u);
}

TEST(ArithmeticTest, WhatIsWrongIsAnErrorLikeAllOthers) {
  EXPECT_THROW(Calculate("1 +", {}), Error);
  EXPECT_THROW(Calculate("a + 1", {}), Error);
}

}  // namespace expression_test
}  // namespace oca::files
