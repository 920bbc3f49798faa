// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/signal_json.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "oca/diagrams/record/message_values.h"
#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/signals.h"

namespace oca {

/// Signals as somebody else may define them: a bare number, an object.
struct Level {
  double value{0.5};
};
template <>
struct Signal<Level> {
  static constexpr const char* kName = "Level";
  static Fault Check(const Level&, Look) { return {}; }
  static void WriteJson(const Level& level, std::string& out) {
    out += std::to_string(level.value);
  }
  static Level ReadJson(std::string_view) { return {}; }
};
struct Mood {
  double charge{1.0};
};
template <>
struct Signal<Mood> {
  static constexpr const char* kName = "Mood";
  static Fault Check(const Mood&, Look) { return {}; }
  static void WriteJson(const Mood& mood, std::string& out) {
    out += R"({"charge":)" + std::to_string(mood.charge) +
           R"(,"good":true,"why":"so","since":null,"parts":[{"a":1}],"all":[]})";
  }
  static Mood ReadJson(std::string_view) { return {}; }
};
struct Babble {};
template <>
struct Signal<Babble> {
  static constexpr const char* kName = "Babble";
  static Fault Check(const Babble&, Look) { return {}; }
  static void WriteJson(const Babble&, std::string& out) { out += "nan"; }
  static Babble ReadJson(std::string_view) { return {}; }
};

}  // namespace oca

namespace oca::record {
namespace signal_json_test {

using nlohmann::json;

std::string Text(const SignalFormat& format, const void* value) {
  std::string out;
  AppendSignal(out, format, value);
  return out;
}

TEST(SignalJsonTest, JointsAreNamedOtherVectorsAreNot) {
  const double values[] = {0.1, -2.0};
  EXPECT_EQ(Text({"plant", "position", &kVectorType, 2, "rad", {"a1", "a2"}}, values),
            R"({"a1":0.1,"a2":-2})");
  EXPECT_EQ(Text({"gain", "out", &kVectorType, 2, "", {}}, values), R"({"values":[0.1,-2]})");
}

TEST(SignalJsonTest, NumbersComeBackToTheLastBit) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 1e22, 0.0, -0.0}) {
    const std::string text = Text({"a", "b", &kVectorType, 1, "", {"x"}}, &value);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(json::parse(text)["x"].get<double>()),
              std::bit_cast<std::uint64_t>(value))
        << text;
  }
}

TEST(SignalJsonTest, WhatIsNotFiniteIsNull) {
  const double values[] = {std::nan(""), std::numeric_limits<double>::infinity()};
  EXPECT_EQ(Text({"a", "b", &kVectorType, 2, "", {}}, values), R"({"values":[null,null]})");
}

TEST(SignalJsonTest, BriefProximitiesAreNamesAndDistance) {
  systems::ProximitySet set;
  set.proximities.resize(1);
  set.proximities[0].link = models::Name("hand");
  set.proximities[0].obstacle = models::Name("box");
  set.proximities[0].distance = 0.25;
  SignalFormat format{"distance", "proximities", &TypeOf<systems::ProximitySet>(), 0, "", {}};
  format.brief = true;
  EXPECT_EQ(Text(format, &set),
            R"({"proximities":[{"link":"hand","obstacle":"box","distance":0.25}]})");
}

TEST(SignalJsonTest, AMessageIsAnObjectWhateverASignalWrites) {
  const Level level;
  EXPECT_EQ(Text({"tank", "level", &TypeOf<Level>(), 0, "", {}}, &level), R"({"level":0.500000})");
  const Mood mood;
  const json written = json::parse(Text({"me", "mood", &TypeOf<Mood>(), 0, "", {}}, &mood));
  EXPECT_EQ(written["charge"], 1.0);
  EXPECT_FALSE(written.contains("mood"));
}

TEST(SignalJsonTest, TheSchemaOfAForeignSignalIsThatOfItsMessages) {
  const auto schema = [](const SignalType& type) {
    return json::parse(ChannelOf({"system", "port", &type, 0, "", {}}).schema);
  };
  EXPECT_EQ(schema(TypeOf<Level>())["properties"],
            json::parse(R"({"port":{"type":["number","null"]}})"));
  const json mood = schema(TypeOf<Mood>());
  EXPECT_EQ(mood["x-signal"], "Mood");
  EXPECT_EQ(mood["properties"], json::parse(R"({
      "charge": {"type": ["number", "null"]}, "good": {"type": "boolean"},
      "why": {"type": "string"}, "since": {},
      "parts": {"type": "array",
                "items": {"type": "object", "properties": {"a": {"type": ["number", "null"]}}}},
      "all": {"type": "array", "items": {"type": "object"}}})"));
  EXPECT_EQ(schema(TypeOf<systems::ProximitySet>())["properties"],
            json::parse(R"({"port":{"type":"array","items":{"type":"object"}}})"));
}

TEST(SignalJsonTest, ATypeThatWritesNoJsonIsNamed) {
  EXPECT_THAT(([] {
                ChannelOf({"system", "port", &TypeOf<Babble>(), 0, "", {}});
              }),
              testing::ThrowsMessage<ConfigError>(testing::HasSubstr("signal type Babble")));
}

std::string Short(double number) {
  std::string text;
  AppendShort(text, number);
  return text;
}

TEST(SignalJsonTest, PicturesHaveMillionths) {
  EXPECT_EQ(Short(0.0), "0");
  EXPECT_EQ(Short(-0.0), "0");
  EXPECT_EQ(Short(1.5), "1.5");
  EXPECT_EQ(Short(-0.000001), "-0.000001");
  EXPECT_EQ(Short(-0.0000004), "0");
  EXPECT_EQ(Short(0.9999996), "1");
  EXPECT_EQ(Short(12.03), "12.03");
  EXPECT_EQ(Short(100.0), "100");
  EXPECT_EQ(json::parse(Short(1e12)), 1e12);
  EXPECT_EQ(Short(std::nan("")), "null");
}

TEST(SignalJsonTest, Base64IsThatOfTheStandard) {
  // RFC 4648, section 10.
  for (const auto& [bytes, expected] : std::vector<std::pair<std::string, std::string>>{
           {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}}) {
    std::string out;
    AppendBase64(out, bytes);
    EXPECT_EQ(out, expected);
  }
}

TEST(SignalJsonTest, TimesAreSecondsAndNanoseconds) {
  std::string out;
  AppendTime(out, 1'700'000'000'000'000'001);
  EXPECT_EQ(out, R"({"sec":1700000000,"nsec":1})");
}

}  // namespace signal_json_test
}  // namespace oca::record
