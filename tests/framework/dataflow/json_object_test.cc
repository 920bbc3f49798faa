// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/json_object.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "tests/refusal.h"

namespace oca {
namespace json_object_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(JsonObjectTest, WritesMembersInTheirOrder) {
  std::string text = "before ";
  const std::vector<double> list{1.0, -0.5, 1e300};
  JsonObject(text)
      .Number("charge", 0.1)
      .Flag("low", true)
      .Text("a \"name\"", "x\n")
      .Numbers("list", list)
      .Numbers("none", {});
  EXPECT_EQ(text, R"(before {"charge":0.1,"low":true,"a \"name\"":"x\n","list":[1.0,-0.5,1e+300],)"
                  R"("none":[]})");
  text.clear();
  { JsonObject empty(text); }
  EXPECT_EQ(text, "{}");
}

TEST(JsonObjectTest, IsReadBackBitForBit) {
  const double number = 0.1 + 0.2;
  const std::vector<double> list{-0.0, 5e-324, 1.7976931348623157e308};
  std::string text;
  JsonObject(text).Number("x", number).Flag("f", false).Text("t", "ä").Numbers("l", list);
  const JsonMembers json(text, {"x", "f", "t", "l"});
  EXPECT_EQ(json.Number("x"), number);
  EXPECT_FALSE(json.Flag("f"));
  EXPECT_EQ(json.Text("t"), "ä");
  EXPECT_THAT(json.Numbers("l"), ElementsAre(-0.0, 5e-324, 1.7976931348623157e308));
}

TEST(JsonObjectTest, TextsThatAreNoUtf8AreReplaced) {
  std::string text;
  JsonObject(text).Text("name", "a\xff");
  EXPECT_EQ(text, "{\"name\":\"a\xEF\xBF\xBD\"}");
}

TEST(JsonMembersTest, RefusesWhatIsNotTheObject) {
  const auto refusal = [](const char* text) {
    return test::Refusal<ConfigError>([&] { const JsonMembers json(text, {"charge", "low"}); });
  };
  EXPECT_THAT(refusal("[1]"), StartsWith("got [1]; expected an object with charge, low"));
  EXPECT_THAT(refusal(R"({"charge": 1, "lwo": true})"),
              StartsWith("got the unknown key 'lwo'; expected one of charge, low; did you mean"));
  EXPECT_THAT(refusal(R"({"charge": 1})"), StartsWith("got no such key; expected the key 'low'"));
  EXPECT_THAT(refusal(R"({"charge": )"), HasSubstr("byte"));
  EXPECT_THAT(refusal(R"({"charge": 1, "charge": 2, "low": true})"), HasSubstr("charge"));
}

TEST(JsonMembersTest, RefusesMembersOfOtherKinds) {
  const JsonMembers json(R"({"n": "1", "f": 1, "t": true, "l": [1, "2"], "m": 3})",
                         {"n", "f", "t", "l", "m"});
  const auto refusal = [](const auto& read) { return test::Refusal<ConfigError>(read); };
  EXPECT_EQ(refusal([&] { json.Number("n"); }), R"(n: got "1"; expected a number)");
  EXPECT_EQ(refusal([&] { json.Flag("f"); }), "f: got 1; expected true or false");
  EXPECT_EQ(refusal([&] { json.Text("t"); }), "t: got true; expected a text");
  EXPECT_EQ(refusal([&] { json.Numbers("l"); }), R"(l[1]: got "2"; expected a number)");
  EXPECT_EQ(refusal([&] { json.Numbers("m"); }), "m: got 3; expected a list of numbers");
  EXPECT_THAT(refusal([&] { json.Number("other"); }), HasSubstr("other"));
}

}  // namespace json_object_test
}  // namespace oca
