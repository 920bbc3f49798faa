// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/value.h"

#include <gmock/gmock.h>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca {
namespace value_test {

const auto kFile = std::make_shared<const std::string>("arm.yaml");

TEST(LocationTest, ReadsAsFileLineColumn) {
  EXPECT_EQ((Location{kFile, 3, 14}.ToString()), "arm.yaml:3:14");
  EXPECT_EQ((Location{std::make_shared<const std::string>("-s"), 0, 0}.ToString()), "-s");
  EXPECT_EQ(Location().ToString(), "parameters");
}

TEST(ValueTest, KnowsItsKindAndNoOther) {
  const Value nothing;
  const Value boolean(true, {});
  const Value integer(std::int64_t{7}, {});
  const Value real(2.5, {});
  const Value text(std::string("seven"), {});
  EXPECT_TRUE(nothing.null());
  EXPECT_TRUE(*boolean.boolean());
  EXPECT_EQ(*integer.integer(), 7);
  EXPECT_EQ(*text.string(), "seven");
  EXPECT_EQ(real.integer(), nullptr);
  EXPECT_EQ(boolean.integer(), nullptr);
  EXPECT_EQ(integer.boolean(), nullptr);
  EXPECT_EQ(text.list(), nullptr);
  EXPECT_EQ(nothing.map(), nullptr);
  EXPECT_FALSE(integer.null());
}

TEST(ValueTest, IntegersAreNumbersAndTextsAreNot) {
  double number = -1.0;
  EXPECT_TRUE(Value(std::int64_t{7}, {}).number(number));
  EXPECT_EQ(number, 7.0);
  EXPECT_TRUE(Value(2.5, {}).number(number));
  EXPECT_EQ(number, 2.5);
  EXPECT_FALSE(Value(std::string("7"), {}).number(number));
  EXPECT_FALSE(Value(true, {}).number(number));
  EXPECT_FALSE(Value().number(number));
  EXPECT_EQ(number, 2.5);
}

TEST(ValueTest, FindsTheEntriesOfAMap) {
  const Value map(Value::Map{{"a", {}, Value(1.0, {})}, {"b", {}, Value(2.0, {})}}, {});
  double number = 0.0;
  ASSERT_NE(map.Find("b"), nullptr);
  EXPECT_TRUE(map.Find("b")->number(number));
  EXPECT_EQ(number, 2.0);
  EXPECT_EQ(map.Find("c"), nullptr);
  EXPECT_EQ(Value(1.0, {}).Find("a"), nullptr);
}

TEST(ValueTest, ShowsItselfForMessages) {
  EXPECT_EQ(Value().Show(), "nothing");
  EXPECT_EQ(Value(false, {}).Show(), "false");
  EXPECT_EQ(Value(std::int64_t{-7}, {}).Show(), "-7");
  EXPECT_EQ(Value(0.1, {}).Show(), "0.1");
  EXPECT_EQ(Value(std::string("text"), {}).Show(), "'text'");
  EXPECT_EQ(Value(Value::List{}, {}).Show(), "a list");
  EXPECT_EQ(Value(Value::Map{}, {}).Show(), "a map");
  EXPECT_EQ(Value(std::string(60, 'a'), {}).Show(), "'" + std::string(60, 'a') + "'");
  EXPECT_EQ(Value(std::string(61, 'a'), {}).Show(), "'" + std::string(60, 'a') + "...'");
}

TEST(ProblemsTest, AreThrownTogetherOneALine) {
  Problems problems;
  EXPECT_NO_THROW(problems.Throw());
  EXPECT_TRUE(problems.empty());
  problems.Add({kFile, 1, 2}, "first");
  problems.Add({kFile, 3, 4}, "second");
  EXPECT_FALSE(problems.empty());
  try {
    problems.Throw();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "arm.yaml:1:2: error: first\narm.yaml:3:4: error: second");
  }
}

TEST(DiagnosticTest, ShowsItsPlaceItsKindAndWhatItSays) {
  Diagnostic diagnostic;
  diagnostic.location = {kFile, 1, 2};
  diagnostic.what = "what: error: no";
  EXPECT_EQ(diagnostic.ToString(), "arm.yaml:1:2: error: what: error: no");
  diagnostic.kind = Diagnostic::Kind::kWarning;
  EXPECT_EQ(diagnostic.ToString(), "arm.yaml:1:2: warning: what: error: no");
}

TEST(DidYouMeanTest, SuggestsTheNearestName) {
  const std::vector<std::string> names{"gain", "max_distance", "min_distance", "period"};
  EXPECT_EQ(DidYouMean("gian", names), "; did you mean 'gain'?");
  EXPECT_EQ(DidYouMean("gain", names), "");  // the word itself is no other one
  EXPECT_EQ(DidYouMean("max_distanse", names), "; did you mean 'max_distance'?");
  EXPECT_EQ(DidYouMean("perod", names), "; did you mean 'period'?");
  EXPECT_EQ(DidYouMean("", names), "");
  EXPECT_EQ(DidYouMean("completely_else", names), "");
  EXPECT_EQ(DidYouMean("gain", {}), "");
}

TEST(DidYouMeanTest, AllowsTwoEditsOrAThirdOfTheWordAndNoMore) {
  const std::vector<std::string> names{"abcdefghi"};
  EXPECT_NE(DidYouMean("abcdefxyz", names), "");  // 3 of 9
  EXPECT_EQ(DidYouMean("abcdewxyz", names), "");  // 4 of 9
  const std::vector<std::string> brief{"abc"};
  EXPECT_NE(DidYouMean("axy", brief), "");  // 2 of 3
  EXPECT_EQ(DidYouMean("xyz", brief), "");  // nothing in common
  EXPECT_EQ(DidYouMean("xy", brief), "");
}

TEST(DidYouMeanTest, CountsATranspositionOnce) {
  const std::vector<std::string> names{"ba__", "ab"};
  EXPECT_EQ(DidYouMean("ba", names), "; did you mean 'ab'?");
}

TEST(DidYouMeanTest, DoesNotTryHugeWords) {
  const std::vector<std::string> names{std::string(201, 'a')};
  EXPECT_EQ(DidYouMean(std::string(201, 'a'), names), "");
}

}  // namespace value_test
}  // namespace oca
