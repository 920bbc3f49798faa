// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/variation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "oca/framework/dataflow/error.h"

namespace oca::sweep {
namespace variation_test {

using testing::ElementsAre;
using testing::HasSubstr;

std::set<std::string> DrawnOf(const char* text, int draws = 2000) {
  const Variation variation = Variation::Parse(text);
  std::set<std::string> drawn;
  for (int seed = 0; seed < draws; ++seed) {
    drawn.insert(variation.Draw(static_cast<std::uint64_t>(seed)));
  }
  return drawn;
}

TEST(VariationTest, ListsValuesAndKeepsTheCommasWithinThem) {
  const Variation variation = Variation::Parse("parameters.a = [1, 2],'x, y', plain(er");
  EXPECT_TRUE(variation.listed());
  EXPECT_EQ(variation.path(), "parameters.a");
  EXPECT_THAT(variation.values(), ElementsAre("[1, 2]", "'x, y'", "plain(er"));
  EXPECT_THAT(Variation::Parse("a=report").values(), ElementsAre("report"));
}

TEST(VariationTest, DrawsUniformlyWithinTheBounds) {
  const Variation variation = Variation::Parse("parameters.x=uniform(.4, 1)");
  EXPECT_FALSE(variation.listed());
  double sum = 0.0, least = 2.0, largest = 0.0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const double value = std::stod(variation.Draw(seed));
    least = std::min(least, value);
    largest = std::max(largest, value);
    sum += value;
  }
  EXPECT_GE(least, 0.4);
  EXPECT_LT(largest, 1.0);
  EXPECT_LT(least, 0.402);
  EXPECT_GT(largest, 0.998);
  EXPECT_NEAR(sum / 4000.0, 0.7, 0.01);
}

TEST(VariationTest, DrawsEveryStepAndNoOther) {
  EXPECT_THAT(DrawnOf("x=uniform(.4,.6,step=.05)"),
              ElementsAre("0.4", "0.45", "0.5", "0.55", "0.6"));
  EXPECT_THAT(DrawnOf("x=uniform(0,1,step=0.4)"), ElementsAre("0", "0.4", "0.8"));
  EXPECT_THAT(DrawnOf("x=integers(-1, 1)"), ElementsAre("-1", "0", "1"));
  EXPECT_THAT(DrawnOf("x=integers(7, 7)"), ElementsAre("7"));
  EXPECT_THAT(DrawnOf("x=choice(a, [b, c])"), ElementsAre("[b, c]", "a"));
}

TEST(VariationTest, DependsOnSeedAndPathAlone) {
  const Variation x = Variation::Parse("x=uniform(0,1)");
  EXPECT_EQ(x.Draw(5), Variation::Parse("x=uniform(0, 1)").Draw(5));
  EXPECT_NE(x.Draw(5), x.Draw(6));
  EXPECT_NE(x.Draw(5), Variation::Parse("y=uniform(0,1)").Draw(5));
}

TEST(VariationTest, RefusesWhatItDoesNotUnderstand) {
  for (const auto& [text, why] : {std::pair("x", "has no '='"),
                                  {"=1", "has no PATH"},
                                  {"x=", "a value of nothing"},
                                  {"x=1,,2", "a value of nothing"},
                                  {"x=uniform(1)", "two bounds"},
                                  {"x=uniform(1,2,3)", "step="},
                                  {"x=uniform(1,2,step=0)", "not positive"},
                                  {"x=uniform(1,2,step=nan)", "'nan' is no number"},
                                  {"x=uniform(1,1e999)", "'1e999' is no number"},
                                  {"x=uniform(2,1)", "wrong way round"},
                                  {"x=uniform(a,1)", "'a' is no number"},
                                  {"x=integers(1,2.5)", "no integer"},
                                  {"x=integers(3,2)", "wrong way round"},
                                  {"x=integers(0,1e12)", "beyond 1e9"},
                                  {"x=choice()", "argument is missing"},
                                  {"x=unifrom(1,2)", "did you mean 'uniform'?"},
                                  {"simulator.seed=1,2", "the seed is that of the sample"}}) {
    try {
      Variation::Parse(text);
      FAIL() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why)) << text;
      EXPECT_THAT(error.what(), HasSubstr("integers(LOWER, UPPER)")) << text;
    }
  }
}

}  // namespace variation_test
}  // namespace oca::sweep
