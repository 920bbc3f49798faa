// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/filter_activity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace filter_activity_test {

const char* const kText =
    R"({"status":"iteration_limit","rows":9,"dropped":1,"yields":2,"slack":0.5,"margin":0.01,)"
    R"("kkt_residual":0.25,"gap":0.125,"bounds":[{"kind":"distance","link":"hand","obstacle":"box",)"
    R"("multiplier":2.0,"slack":0.5},{"kind":"upper","joint":"elbow","limit":"acceleration",)"
    R"("multiplier":3.0}]})";

TEST(FilterActivityTest, WritesWhatItReads) {
  std::string text;
  Signal<FilterActivity>::WriteJson(Signal<FilterActivity>::ReadJson(kText), text);
  EXPECT_EQ(text, kText);
}

TEST(FilterActivityTest, RefusesAStatusOrAKindThatThereIsNot) {
  std::string text = kText;
  text.replace(text.find("iteration_limit"), 15, "tired");
  EXPECT_THROW(Signal<FilterActivity>::ReadJson(text), ConfigError);
  text = kText;
  text.replace(text.find("upper"), 5, "outer");
  EXPECT_THROW(Signal<FilterActivity>::ReadJson(text), ConfigError);
}

TEST(FilterActivityTest, IsNotFiniteIfANumberOfItIsNot) {
  FilterActivity activity = Signal<FilterActivity>::ReadJson(kText);
  EXPECT_TRUE(Signal<FilterActivity>::Check(activity, Look::kFinite).ok());
  activity.bounds[1].multiplier = std::nan("");
  EXPECT_FALSE(Signal<FilterActivity>::Check(activity, Look::kFinite).ok());
  activity.num_bounds = 1;  // those beyond do not count
  EXPECT_TRUE(Signal<FilterActivity>::Check(activity, Look::kFinite).ok());
  activity.gap = INFINITY;
  EXPECT_FALSE(Signal<FilterActivity>::Check(activity, Look::kFinite).ok());
}

}  // namespace filter_activity_test
}  // namespace oca::systems
