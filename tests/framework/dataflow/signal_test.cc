// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/signal.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace signal_test {

using testing::HasSubstr;
using Limits = std::numeric_limits<double>;

TEST(SignalTest, AllFiniteSeesANaNOrInfinityAtEveryPosition) {
  for (std::size_t size = 0; size <= 20; ++size) {
    std::vector<double> values(size, -Limits::max());
    EXPECT_TRUE(AllFinite(values.data(), size));
    for (std::size_t i = 0; i < size; ++i) {
      for (const double bad : {Limits::quiet_NaN(), -Limits::quiet_NaN(), Limits::infinity(),
                               -Limits::infinity(), Limits::signaling_NaN()}) {
        values[i] = bad;
        EXPECT_FALSE(AllFinite(values.data(), size)) << i << " of " << size;
      }
      values[i] = Limits::denorm_min();
    }
    EXPECT_TRUE(AllFinite(values.data(), size));
  }
}

TEST(SignalTest, AllFiniteAcceptsTheLargestAndSmallestNumbers) {
  for (const double good :
       {Limits::max(), Limits::lowest(), Limits::min(), Limits::denorm_min(), 0.0, -0.0, 1.0}) {
    EXPECT_TRUE(AllFinite(&good, 1)) << good;
  }
}

Eigen::VectorXd RoundTrip(const std::vector<double>& values) {
  std::string text;
  WriteVectorJson(values.data(), values.size(), text);
  return ReadVectorJson(text);
}

TEST(SignalTest, JsonBringsEveryBitBack) {
  std::mt19937_64 random(11);
  std::vector<double> values{0.0,           -0.0,
                             1.0,           -1.0,
                             0.1,           1.0 / 3.0,
                             5e-324,        -5e-324,
                             Limits::max(), Limits::lowest(),
                             Limits::min(), 9007199254740993.0,
                             1e15,          1e16,
                             1e17,          123456789012345678.0,
                             1e22,          1e-7};
  while (values.size() < 20000) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  const Eigen::VectorXd back = RoundTrip(values);
  ASSERT_EQ(back.size(), static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(values[i]),
              std::bit_cast<std::uint64_t>(back[static_cast<Eigen::Index>(i)]))
        << values[i];
  }
}

TEST(SignalTest, JsonOfVectorsIsShortAndAppended) {
  std::string text = "x=";
  const std::vector<double> values{1.0, 0.1, -2.5e-10};
  WriteVectorJson(values.data(), values.size(), text);
  EXPECT_EQ(text, "x=[1,0.1,-2.5e-10]");
  EXPECT_EQ(RoundTrip({}).size(), 0);
}

TEST(SignalTest, NumbersThatJsonCannotSayAreNull) {
  std::string text;
  const std::vector<double> values{Limits::quiet_NaN(), 1.0, -Limits::infinity()};
  WriteVectorJson(values.data(), values.size(), text);
  EXPECT_EQ(text, "[null,1,null]");
}

TEST(SignalTest, ReadingRefusesWhatIsNoListOfFiniteNumbers) {
  const auto text_of = [](const char* json) -> std::string {
    try {
      ReadVectorJson(json);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  for (const char* bad : {"7", "{}", "null", "\"[1]\""}) {
    EXPECT_THAT(text_of(bad), HasSubstr("expected a list of numbers")) << bad;
  }
  for (const char* bad : {"", "[1,", "[1,]", "[NaN]", "[01]", "[1] 2", "nonsense"}) {
    EXPECT_THAT(text_of(bad), HasSubstr("expected valid JSON")) << bad;
  }
  EXPECT_THAT(text_of("[1e999]"), HasSubstr("expected finite numbers"));
  EXPECT_EQ(text_of("[1, \"2\"]"), "item 1: got \"2\"; expected a number");
  EXPECT_EQ(text_of("[null]"), "item 0: got null; expected a number");
  EXPECT_EQ(text_of("[1, 2, true]"), "item 2: got true; expected a number");
  EXPECT_EQ(text_of("[[1]]"), "item 0: got [1]; expected a number");
  EXPECT_EQ(text_of(" [1, 2] "), "");
}

TEST(SignalTest, TheTypeEntryHandlesValuesWithoutTheirCppType) {
  const SignalType& type = TypeOf<Label>();
  EXPECT_EQ(&type, &TypeOf<Label>());
  EXPECT_STREQ(type.name, "Label");
  EXPECT_EQ(type.size, sizeof(Label));
  EXPECT_EQ(&TypeOf<Vector>(), &kVectorType);
  alignas(Label) std::byte memory[2][sizeof(Label)];
  type.construct(memory[0]);
  type.construct(memory[1]);
  type.read_json("hello", memory[0]);
  type.assign(memory[1], memory[0]);
  std::string json;
  type.write_json(memory[1], json);
  EXPECT_EQ(json, "\"hello\"");
  EXPECT_TRUE(type.check(memory[1], Look::kFinite).ok());
  EXPECT_THROW(type.read_json("nan", memory[1]), ConfigError);  // and leaves the value
  EXPECT_TRUE(type.check(memory[1], Look::kFinite).ok());
  const Label bad{"nan"};
  EXPECT_FALSE(type.check(&bad, Look::kFinite).ok());
  type.destroy(memory[0]);
  type.destroy(memory[1]);
}

}  // namespace signal_test
}  // namespace oca
