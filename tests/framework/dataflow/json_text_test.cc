// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/json_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"

namespace oca::internal {
namespace json_text_test {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

template <class Call>
std::string Refusal(const Call& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

std::string RefusalOf(const std::string& text) {
  return Refusal([&] { ReadJsonTree(text); });
}

std::string Nested(int levels) { return std::string(levels, '[') + std::string(levels, ']'); }

TEST(JsonTextTest, SaysWhereATextIsNoJson) {
  EXPECT_EQ(RefusalOf(R"({"a": 1})"), "accepted");
  EXPECT_EQ(RefusalOf(R"({"a": 1,})"), "JSON: byte 9: syntax; got '}'; expected valid JSON");
  EXPECT_EQ(RefusalOf(R"({"a": [1, -2.5e400]})"),
            "JSON: byte 11: number; got -2.5e400; expected finite numbers, up to 1.8e308");
  EXPECT_EQ(RefusalOf("[1e999,-2]"),
            "JSON: byte 2: number; got 1e999; expected finite numbers, up to 1.8e308");
  EXPECT_EQ(RefusalOf("[[3,1e999,2]]"),
            "JSON: byte 5: number; got 1e999; expected finite numbers, up to 1.8e308");
  EXPECT_EQ(RefusalOf(R"({"a":1,"\u0061":2})"),
            "JSON: byte 8: duplicate key; got 'a'; expected each key once");
  EXPECT_EQ(RefusalOf(R"({"a\"\\":1,"b":"a\"\\","a\"\\":2})"),
            R"(JSON: byte 24: duplicate key; got 'a"\'; expected each key once)");
  EXPECT_EQ(RefusalOf("1e999"),
            "JSON: byte 1: number; got 1e999; expected finite numbers, up to 1.8e308");
  EXPECT_EQ(RefusalOf(R"({"a": 1, "b": {"a": 2, "b": 3}, "a": 4})"),
            "JSON: byte 33: duplicate key; got 'a'; expected each key once");
  EXPECT_EQ(RefusalOf("[1"), "JSON: byte 3: syntax; got its end; expected valid JSON");
  EXPECT_THAT(RefusalOf(""), HasSubstr("got its end"));
  EXPECT_THAT(RefusalOf("\x1b[2J"), HasSubstr("got '?[2J'"));
  EXPECT_THAT(RefusalOf("\"caf\xE9\""), HasSubstr("expected valid JSON"));
  EXPECT_THAT(RefusalOf("[1e999]"), HasSubstr("expected finite numbers"));
}

TEST(JsonTextTest, TakesSixtyFourLevelsAndNoMore) {
  EXPECT_EQ(RefusalOf(Nested(64)), "accepted");
  EXPECT_THAT(RefusalOf(Nested(65)), StartsWith("JSON: byte 65: nested too deep"));
  EXPECT_THAT(RefusalOf(std::string(1'000'000, '[')), HasSubstr("nested too deep"));
  EXPECT_EQ(RefusalOf("\"" + std::string(100, '[') + "\\\"[\""), "accepted");  // in a text
}

TEST(JsonTextTest, TakesWholeNumbersOfItsTypeAlone) {
  const auto refusal = [](const ordered_json& json) {
    return Refusal([&] { WholeNumber<std::uint32_t>(json); });
  };
  EXPECT_EQ(WholeNumber<std::uint32_t>(4294967295), 4294967295u);
  EXPECT_EQ(WholeNumber<std::int64_t>(INT64_MIN), INT64_MIN);
  for (const ordered_json& bad :
       {ordered_json(-1), ordered_json(4294967296), ordered_json(1.0), ordered_json(UINT64_MAX),
        ordered_json("1"), ordered_json(true), ordered_json(), ordered_json::array({1})}) {
    EXPECT_THAT(refusal(bad), HasSubstr("expected a whole number from 0 to 4294967295")) << bad;
  }
}

TEST(JsonTextTest, WritesWhatIsNoUtf8WithReplacements) {
  EXPECT_EQ(JsonText(ordered_json("caf\xE9")), "\"caf\xEF\xBF\xBD\"");
  EXPECT_EQ(JsonText(ordered_json{{"a", 1}}, 1), "{\n \"a\": 1\n}");
}

TEST(ExplainTest, HasWordsForWhatTheLibraryThrows) {
  EXPECT_THAT(Explain(std::bad_alloc()), StartsWith("memory; got"));
  EXPECT_THAT(Explain(std::length_error("vector::reserve")), StartsWith("memory; got"));
  EXPECT_EQ(Explain(std::filesystem::filesystem_error(
                "cannot x", "/a/b", std::make_error_code(std::errc::permission_denied))),
            "/a/b: Permission denied");
  try {
    ordered_json::parse("{").size();
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(Explain(error), StartsWith("JSON: "));
    EXPECT_THAT(Explain(error), Not(HasSubstr("exception")));
  }
  EXPECT_EQ(Explain(ConfigError("gain; got -1")), "gain; got -1");
  EXPECT_EQ(Explain(std::runtime_error("of a block")), "of a block");
}

}  // namespace json_text_test
}  // namespace oca::internal
