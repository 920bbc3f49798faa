// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/diagrams/files/json_reader.h"
#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/files/yaml_text.h"

namespace oca::files {
namespace yaml_reader_test {

using testing::HasSubstr;
using testing::StartsWith;

TEST(YamlReaderTest, KnowsWhereEveryNodeStands) {
  const YamlText text("a: 1\nb:\n  c: [x, 2.5]\n  'd e': {f: true}\n");
  EXPECT_EQ(text.problems, "");
  const Value b = At(text.value, "b");
  EXPECT_EQ(At(text.value, "a").location().ToString(), "f.yaml:1:4");
  EXPECT_EQ(b.location().ToString(), "f.yaml:3:3");
  EXPECT_EQ(b.map()->at(1).location.ToString(), "f.yaml:4:3");
  EXPECT_EQ(At(b, "c").list()->at(1).location().ToString(), "f.yaml:3:10");
  EXPECT_EQ(At(b, "d e", "f").location().ToString(), "f.yaml:4:14");
}

TEST(YamlReaderTest, KeepsTheOrderOfKeys) {
  const YamlText text("z: 1\na: 2\nm: 3\n");
  ASSERT_EQ(text.value.map()->size(), 3u);
  EXPECT_EQ(text.value.map()->at(0).key, "z");
  EXPECT_EQ(text.value.map()->at(1).key, "a");
  EXPECT_EQ(text.value.map()->at(2).key, "m");
}

TEST(YamlReaderTest, TellsNumbersBooleansAndTextApart) {
  const YamlText text(
      "{i: -42, plus: +7, r: 2.5e-3, dot: .5, tail: 5., big: 99999999999999999999, t: true, "
      "f: false, s: hello world, q: '12', d: \"true\", hex: 0x10, time: 12:30}");
  EXPECT_EQ(text.problems, "");
  ASSERT_NE(At(text.value, "i").integer(), nullptr);
  EXPECT_EQ(*At(text.value, "i").integer(), -42);
  EXPECT_EQ(*At(text.value, "plus").integer(), 7);
  EXPECT_EQ(At(text.value, "r").integer(), nullptr);
  EXPECT_EQ(Number(At(text.value, "r")), 2.5e-3);
  EXPECT_EQ(Number(At(text.value, "dot")), 0.5);
  EXPECT_EQ(Number(At(text.value, "tail")), 5.0);
  EXPECT_EQ(Number(At(text.value, "big")), 1e20);
  EXPECT_TRUE(*At(text.value, "t").boolean());
  EXPECT_FALSE(*At(text.value, "f").boolean());
  for (const char* key : {"s", "q", "d", "hex", "time"}) {
    EXPECT_NE(At(text.value, key).string(), nullptr) << key;
  }
  EXPECT_EQ(*At(text.value, "q").string(), "12");
}

TEST(YamlReaderTest, NamesBothPlacesOfADuplicateKey) {
  EXPECT_EQ(YamlText("a: 1\nb: 2\na: 3\n").problems,
            "f.yaml:3:1: error: a: duplicate key; the first is at f.yaml:1:1\n");
  EXPECT_THAT(YamlText("m: {k: 1, k: {x: 2}}\n").problems, HasSubstr("k: duplicate key"));
  EXPECT_THAT(YamlText("k: 1\n'k': 2\n").problems, HasSubstr("k: duplicate key"));
  EXPECT_EQ(YamlText("a: {k: 1}\nb: {k: 1}\n").problems, "");
}

TEST(YamlReaderTest, RefusesAnchorsAliasesAndMergeKeys) {
  EXPECT_THAT(YamlText("a: &x 1\n").problems, HasSubstr("f.yaml:1:4: error: an anchor"));
  EXPECT_THAT(YamlText("a: &x {b: 1}\n").problems, HasSubstr("an anchor"));
  EXPECT_THAT(YamlText("a: &x [1]\nb: *x\n").problems, HasSubstr("f.yaml:2:4: error: an alias"));
  EXPECT_THAT(YamlText("a: {<<: {b: 1}}\n").problems, HasSubstr("the merge key '<<'"));
}

TEST(YamlReaderTest, RefusesTagsEvenTheEmptyOne) {
  for (const char* text : {"a: !!int '3'\n", "a: !mine 3\n", "a: !<x> 3\n", "a: ! 12\n",
                           "a: ! {b: 1}\n", "a: ! [1]\n", "a: ! '12'\n", "!x a: 1\n"}) {
    EXPECT_THAT(YamlText(text).problems, HasSubstr("the tag '")) << text;
  }
}

TEST(YamlReaderTest, RefusesASecondDocument) {
  EXPECT_EQ(YamlText("---\na: 1\n").problems, "");
  EXPECT_EQ(YamlText("a: 1\n...\n").problems, "");
  EXPECT_THAT(YamlText("a: 1\n---\nb: 2\n").problems, HasSubstr("a second document"));
  EXPECT_THAT(YamlText("a: 1\n...\n---\nb: 2\n").problems, HasSubstr("a second document"));
}

TEST(YamlReaderTest, RefusesKeysAndItemsWithoutAValue) {
  EXPECT_THAT(YamlText("a:\nb: 1\n").problems, HasSubstr("error: a: no value"));
  EXPECT_THAT(YamlText("a: {b: 1, c}\n").problems, HasSubstr("error: c: no value"));
  EXPECT_THAT(YamlText("a:\n  - 1\n  -\n").problems, HasSubstr("an item without a value"));
  EXPECT_THAT(YamlText("a: null\n").problems, HasSubstr("error: a: no value"));
  EXPECT_THAT(YamlText("a: ~\n").problems, HasSubstr("error: a: no value"));
  EXPECT_THAT(YamlText("a: Null\n").problems, HasSubstr("error: a: "));
  EXPECT_NE(YamlText("a: [1, , 2]\n").problems, "");
  EXPECT_NE(YamlText("? {x: 1}\n: 2\n").problems, "");
  EXPECT_NE(YamlText("? [x]\n: 2\n").problems, "");
  EXPECT_NE(YamlText(": 2\n").problems, "");
}

TEST(YamlReaderTest, RefusesWordsThatOtherReadersTakeForBooleans) {
  for (const char* word : {"no", "Yes", "on", "OFF", "y", "N", "True", "FALSE"}) {
    const std::string text = std::string("a: ") + word + "\n";
    EXPECT_THAT(YamlText(text).problems, HasSubstr("expected true or false")) << word;
    const std::string quoted = std::string("a: '") + word + "'\n";
    EXPECT_EQ(YamlText(quoted).problems, "") << word;
  }
}

TEST(YamlReaderTest, RefusesNumbersThatAreReadInSurprisingWays) {
  for (const char* number : {"010", "-007", "00", "01.5"}) {
    EXPECT_THAT(YamlText("a: " + std::string(number)).problems, HasSubstr("leading zeros"))
        << number;
  }
  for (const char* number : {"0", "-0", "0.1", "0e3", "10"}) {
    EXPECT_EQ(YamlText("a: " + std::string(number)).problems, "") << number;
  }
  EXPECT_THAT(YamlText("a: 1e400").problems, HasSubstr("a number that a double can hold"));
  EXPECT_THAT(YamlText("a: -1e400").problems, HasSubstr("a number that a double can hold"));
  EXPECT_EQ(Number(At(YamlText("a: 1e308").value, "a")), 1e308);
}

TEST(YamlReaderTest, RefusesQuotesThatAreNotClosed) {
  EXPECT_THAT(YamlText("a: \"open\n").problems, HasSubstr("f.yaml:1:4: error: a quote \""));
  EXPECT_THAT(YamlText("a: 'open\n").problems, HasSubstr("f.yaml:1:4: error: a quote '"));
  EXPECT_THAT(YamlText("a: 'it''s open\n").problems, HasSubstr("not closed"));
  EXPECT_THAT(YamlText("a: \"open \\\"\n").problems, HasSubstr("not closed"));
  EXPECT_THAT(YamlText("'open: 1\n").problems, HasSubstr("not closed"));
  EXPECT_EQ(YamlText("a: 'it''s closed'\nb: \"\\\"\"\nc: ''\n").problems, "");
  EXPECT_NE(YamlText("a: \"open\nb: \"closed\"\n").problems, "");
}

TEST(YamlReaderTest, SaysInItsOwnWordsWhatIsNoYaml) {
  const auto starts = [](const std::string& text) { return testing::StartsWith(text); };
  const auto problems = [](const std::string& text) { return YamlText(text).problems; };
  EXPECT_THAT(problems("systems:\n\ta: {type: Constant}\n"),
              starts("f.yaml:2:3: error: no YAML; got a tab before the text of a line; expected"));
  EXPECT_THAT(
      problems("a: 1\n" + std::string(1025, 'k') + ": 2\n"),
      HasSubstr("no YAML; got a colon where no key ends; expected 'key: value' with the key "
                "on this line, of at most 1024 characters"));
  EXPECT_THAT(problems("a: b: c\n"), HasSubstr("got a colon where no key ends"));
  EXPECT_THAT(problems("systems: {k: {type: Con"),
              starts("f.yaml:1:24: error: no YAML; got a { that nothing closes; expected } or a"));
  EXPECT_THAT(problems("a: 1\nb: {c: 1\n"), starts("f.yaml:3:1: error: no YAML; got a {"));
  EXPECT_THAT(problems("a: {b: 1\nc: 2}\n"), HasSubstr("f.yaml:2:"));
  EXPECT_THAT(problems("a: [1, 2\n"), HasSubstr("got a [ that nothing closes"));
  EXPECT_THAT(problems("%YAML 9.9\n---\na: 1\n"),
              HasSubstr("no YAML; got a directive %; expected %YAML 1.2, %TAG or none"));
  EXPECT_THAT(problems("a: 1\n b: 2\n"), HasSubstr("no YAML; got "));
  EXPECT_THAT(problems("a:\n  - 1\n b: 2\n"), HasSubstr("no YAML; got a line that belongs to no"));
  EXPECT_THAT(problems("a: \"\\q\"\n"), HasSubstr("no YAML; got a backslash"));
  EXPECT_THAT(problems("a: @b\n"), HasSubstr("no YAML; got a character that begins no value"));
  EXPECT_THAT(problems("a: *\n"), HasSubstr("no YAML; got no name behind & or *"));
}

TEST(YamlReaderTest, FindsOpenQuotesBehindTextThatIsNotAscii) {
  EXPECT_EQ(YamlText("a: Grüße\nb: 'closed'\n").problems, "");
  EXPECT_THAT(YamlText("a: Grüße\nb: 'open\n").problems, HasSubstr("f.yaml:2:4"));
}

TEST(YamlReaderTest, ReadsAFileWithAByteOrderMark) {
  const YamlText text(
      "\xEF\xBB\xBF"
      "a: 'closed'\nb: 2\n");
  EXPECT_EQ(text.problems, "");
  EXPECT_EQ(*At(text.value, "a").string(), "closed");
  EXPECT_THAT(YamlText("\xEF\xBB\xBF"
                       "a: 'open\n")
                  .problems,
              HasSubstr("not closed"));
}

TEST(YamlReaderTest, RefusesTextThatIsNotUtf8) {
  for (const char* text : {"a: \xff\n", "a: \xc3\n", "a: '\xe2\x82'\n",
                           "\xff\xfe"
                           "a: 1\n",
                           "a: \xc0\xaf\n", "a: \xed\xa0\x80\n", "a: \xf5\x80\x80\x80\n"}) {
    EXPECT_THAT(YamlText(text).problems, HasSubstr("UTF-8")) << testing::PrintToString(text);
  }
  EXPECT_EQ(YamlText("a: \xf0\x9f\xa4\x96 \xe2\x86\x92 \xc3\xbc\n").problems, "");
}

TEST(YamlReaderTest, ReadsCarriageReturnsAsLineEnds) {
  const YamlText text("a: 1\r\nb:\r\n  - x\r\n  - 'y'\r\n");
  EXPECT_EQ(text.problems, "");
  EXPECT_EQ(*At(text.value, "a").integer(), 1);
  EXPECT_EQ(*At(text.value, "b").list()->at(0).string(), "x");
  EXPECT_EQ(At(text.value, "b").list()->at(1).location().line, 4);
}

TEST(YamlReaderTest, RefusesTabsAsIndentation) {
  EXPECT_NE(YamlText("a:\n\tb: 1\n").problems, "");
  EXPECT_EQ(YamlText("a: 1\t# a tab before a comment\n").problems, "");
}

TEST(YamlReaderTest, ReadsNothingFromNothing) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "   \n#\n", "---\n"}) {
    const YamlText empty(text);
    EXPECT_EQ(empty.problems, "") << text;
    EXPECT_TRUE(empty.value.null()) << text;
  }
}

TEST(YamlReaderTest, SaysWhereTheSyntaxBreaks) {
  EXPECT_THAT(YamlText("a: 1\nb: [1, 2\nc: 3\n").problems, HasSubstr("f.yaml:"));
  EXPECT_THAT(YamlText("a: 1\n  b: 2\n").problems, StartsWith("f.yaml:2:"));
  EXPECT_THAT(YamlText("a: @x\n").problems, StartsWith("f.yaml:1:"));
  EXPECT_NE(YamlText("{a: 1\n").problems, "");
  EXPECT_NE(YamlText("a: 1}\nb: ]\n").problems, "");
}

TEST(YamlReaderTest, ReportsSeveralProblemsAtOnce) {
  const std::string problems = YamlText("a: no\na: 010\nb: &x 1\nc:\n").problems;
  EXPECT_THAT(problems, HasSubstr("f.yaml:1:4: error: a: got no"));
  EXPECT_THAT(problems, HasSubstr("f.yaml:2:1: error: a: duplicate key"));
  EXPECT_THAT(problems, HasSubstr("f.yaml:2:4: error: a: got 010"));
  EXPECT_THAT(problems, HasSubstr("f.yaml:3:4: error: an anchor"));
  EXPECT_THAT(problems, HasSubstr("error: c: no value"));
}

TEST(YamlReaderTest, JsonGivesTheSameTree) {
  const Value value = ReadJson(R"({"a": [1, 2.5, true, "x"], "b": {"c": -3}})", "--params");
  EXPECT_EQ(*At(value, "a").list()->at(0).integer(), 1);
  EXPECT_EQ(Number(At(value, "a").list()->at(1)), 2.5);
  EXPECT_TRUE(*At(value, "a").list()->at(2).boolean());
  EXPECT_EQ(*At(value, "a").list()->at(3).string(), "x");
  EXPECT_EQ(*At(value, "b", "c").integer(), -3);
  EXPECT_EQ(At(value, "b", "c").location().ToString(), "--params");
}

TEST(YamlReaderTest, JsonKeepsIntegersThatPassSixtyThreeBits) {
  const Value value = ReadJson(R"([9223372036854775807, 18446744073709551615])", "--params");
  EXPECT_EQ(*value.list()->at(0).integer(), 9223372036854775807);
  EXPECT_EQ(Number(value.list()->at(1)), 18446744073709551615.0);
}

TEST(YamlReaderTest, JsonThatIsWrongIsRefusedByName) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      ReadJson(text, "--params");
      return "accepted";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  for (const char* text : {"", "{", "{\"a\": }", "nonsense", "[1,]", "{\"a\": 1} x", "[1e400]"}) {
    EXPECT_THAT(refusal(text), StartsWith("--params: error: ")) << text;
  }
  EXPECT_THAT(refusal("{\"a\": null}"), HasSubstr("null; expected a value"));
  EXPECT_THAT(refusal("{\"a\": 1, \"a\": 2}"), HasSubstr("duplicate key"));
  EXPECT_THAT(refusal(std::string(100000, '[')), StartsWith("--params: error: "));
  EXPECT_THAT(refusal(std::string(1000, '[') + std::string(1000, ']')),
              HasSubstr("nested too deep"));
}

}  // namespace yaml_reader_test
}  // namespace oca::files
