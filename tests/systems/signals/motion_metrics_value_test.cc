// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/motion_metrics_value.h"

#include <gmock/gmock.h>

namespace oca::systems {
namespace motion_metrics_value_test {

using models::Name;

MotionMetricsValue Left() {
  MotionMetricsValue left;
  left.min_distance = 0.2;
  left.min_distance_link = Name("left_hand");
  left.min_distance_obstacle = Name("box");
  left.min_distance_time = 3.0;
  left.certified_min_distance = 0.1;
  left.contact_time = 0.0;
  left.max_abs_delta = 0.5;
  left.time_to_goal = 4.0;
  left.stuck_time = 2.0;
  left.stuck_amount = 0.01;
  left.stuck_link = Name("left_arm");
  left.stuck_obstacle = Name("box");
  return left;
}

TEST(WorstOfTest, TakesTheNearestApproachWithItsPairAndTimeAndTheLargestOfTheRest) {
  MotionMetricsValue right;
  right.min_distance = -0.1;
  right.min_distance_link = Name("right_hand");
  right.min_distance_obstacle = Name("table");
  right.min_distance_time = 7.0;
  right.contact_time = 1.5;
  right.first_contact_time = 6.0;
  right.max_abs_delta = 0.4;
  right.time_to_goal = 5.0;
  right.stuck_time = 1.0;
  right.stuck_amount = 0.3;
  right.stuck_link = Name("right_arm");
  for (const MotionMetricsValue& worst : {WorstOf(Left(), right), WorstOf(right, Left())}) {
    EXPECT_EQ(worst.min_distance, -0.1);
    EXPECT_EQ(worst.min_distance_link.text(), "right_hand");
    EXPECT_EQ(worst.min_distance_obstacle.text(), "table");
    EXPECT_EQ(worst.min_distance_time, 7.0);
    EXPECT_EQ(worst.contact_time, 1.5);
    EXPECT_EQ(worst.first_contact_time, 6.0);
    EXPECT_EQ(worst.max_abs_delta, 0.5);
    EXPECT_EQ(worst.time_to_goal, 5.0);
    EXPECT_EQ(worst.stuck_time, 2.0);
    EXPECT_EQ(worst.stuck_link.text(), "left_arm");
    EXPECT_EQ(worst.stuck_amount, 0.01) << "of the pair, not the largest";
    EXPECT_EQ(worst.certified_min_distance, std::nullopt) << "known of one only";
  }
}

TEST(WorstOfTest, TakesTheEarliestContactAndTheLeastCertificateOfBoth) {
  MotionMetricsValue right = Left();
  right.certified_min_distance = 0.05;
  right.first_contact_time = 2.0;
  MotionMetricsValue left = Left();
  left.first_contact_time = 3.0;
  EXPECT_EQ(WorstOf(left, right).first_contact_time, 2.0);
  EXPECT_EQ(WorstOf(left, right).certified_min_distance, 0.05);
  right.time_to_goal.reset();
  EXPECT_EQ(WorstOf(left, right).time_to_goal, std::nullopt) << "all are there, or not";
  EXPECT_EQ(WorstOf(left, left), left);
}

TEST(MetricsInTest, AreThoseOfTheJsonInItsOrderAndCanBeSetAgain) {
  const std::vector<Metric> metrics = MetricsIn(Left());
  ASSERT_EQ(metrics.size(), 19u);
  EXPECT_EQ(metrics[0].name, "min_distance");
  EXPECT_EQ(metrics[0].number(), 0.2);
  EXPECT_EQ(metrics[1].name, "min_distance_pair");
  EXPECT_EQ(metrics[1].number(), std::nullopt);
  EXPECT_EQ(metrics.back().name, "stuck_pair");
  MotionMetricsValue again;
  for (const Metric& metric : metrics) EXPECT_TRUE(SetMetric(again, metric)) << metric.name;
  EXPECT_EQ(again, Left());
}

TEST(MetricsInTest, KnowANumberByItsName) {
  EXPECT_EQ(NumberIn(Left(), "max_abs_delta"), 0.5);
  EXPECT_EQ(NumberIn(Left(), "final_error"), std::nullopt);
  EXPECT_EQ(NumberIn(Left(), "min_distance_pair"), std::nullopt);
}

TEST(SetMetricTest, RefusesUnknownNamesAndValuesOfAnotherKind) {
  MotionMetricsValue value;
  EXPECT_FALSE(SetMetric(value, {"min_distanse", 1.0}));
  EXPECT_FALSE(SetMetric(value, {"stuck_pair", 1.0}));
  EXPECT_FALSE(SetMetric(value, {"stuck_time", std::array{Name("a"), Name("b")}}));
  EXPECT_TRUE(SetMetric(value, {"stuck_time", {}}));
}

}  // namespace motion_metrics_value_test
}  // namespace oca::systems
