// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/filter_activity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace oca::systems {
namespace filter_activity_test {

const char* const kText =
    R"({"status":"iteration_limit","rows":9,"dropped":1,"yields":2,"slack":0.5,"margin":0.01,)"
    R"("kkt_residual":0.25,"gap":0.125,"bounds":[{"kind":"distance","link":"hand","obstacle":"box",)"
    R"("multiplier":2.0,"slack":0.5},{"kind":"upper","joint":"elbow","limit":"acceleration",)"
    R"("multiplier":3.0}]})";

FilterActivity Example() {
  FilterActivity activity;
  activity.status = qp::QpStatus::kIterationLimit;
  activity.rows = 9;
  activity.dropped = 1;
  activity.yields = 2;
  activity.slack = 0.5;
  activity.margin = 0.01;
  activity.kkt_residual = 0.25;
  activity.gap = 0.125;
  activity.Add({.kind = FilterBound::Kind::kDistance,
                .link = models::Name("hand"),
                .obstacle = models::Name("box"),
                .multiplier = 2.0,
                .slack = 0.5});
  activity.Add({.kind = FilterBound::Kind::kUpper,
                .link = models::Name("elbow"),
                .limit = motion::MotionLimit::kAcceleration,
                .multiplier = 3.0});
  return activity;
}

TEST(FilterActivityTest, WritesStatusNumbersAndBounds) {
  std::string text;
  Signal<FilterActivity>::WriteJson(Example(), text);
  EXPECT_EQ(text, kText);
}

TEST(FilterActivityTest, IsNotFiniteIfANumberOfItIsNot) {
  FilterActivity activity = Example();
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
