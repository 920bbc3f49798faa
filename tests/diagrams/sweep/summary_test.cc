// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/summary.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "oca/diagrams/sweep/summary_json.h"

namespace oca::sweep {
namespace summary_test {

SampleRow Row(std::int64_t sample,
              const std::optional<systems::MotionMetricsValue>& metrics = std::nullopt) {
  SampleRow row;
  row.sample = sample;
  row.metrics = metrics;
  return row;
}

/// Metrics with a value each.
systems::MotionMetricsValue With(const std::vector<systems::Metric>& values) {
  systems::MotionMetricsValue metrics;
  for (const systems::Metric& value : values)
    EXPECT_TRUE(systems::SetMetric(metrics, value)) << value.name;
  return metrics;
}

TEST(JudgeTest, BelievesTheCertificateBeforeTheSamples) {
  const Verdict sure =
      Judge(Row(0, With({{"min_distance", 0.1}, {"certified_min_distance", 0.05}})), 0.01);
  EXPECT_EQ(sure.clear, true);
  const Verdict unsure =
      Judge(Row(0, With({{"min_distance", 0.1}, {"certified_min_distance", -0.05}})), 0.01);
  EXPECT_EQ(unsure.clear, false);
  EXPECT_EQ(unsure.sampled_clear, true);
  EXPECT_EQ(Judge(Row(0, With({{"min_distance", 0.1}})), 0.01).clear, true);
  EXPECT_EQ(Judge(Row(0, With({{"min_distance", 0.0}})), 0.01).clear, false) << "touch is contact";
}

TEST(JudgeTest, TakesNothingWithinReachForClearAndNoMetricForUnknown) {
  EXPECT_EQ(Judge(Row(0, With({{"contact_time", 0.0}})), 0.01).clear, true);
  // Nothing was there to compare: not clear, not unclear.
  EXPECT_FALSE(Judge(Row(0, With({})), 0.01).clear.has_value());
  EXPECT_FALSE(Judge(Row(0), 0.01).both.has_value());
}

TEST(JudgeTest, ArrivesWithinTheArrivalFromBothSides) {
  EXPECT_EQ(Judge(Row(0, With({{"final_error", 0.01}})), 0.01).arrived, true);
  EXPECT_EQ(Judge(Row(0, With({{"final_error", 0.0100001}})), 0.01).arrived, false);
}

TEST(JudgeTest, CountsARunThatDidNotFinishAsLost) {
  SampleRow row = Row(0, With({{"min_distance", 1.0}, {"final_error", 0.0}}));
  row.outcome = Outcome::kTimedOut;
  const Verdict judgement = Judge(row, 0.01);
  EXPECT_EQ(judgement.clear, false);
  EXPECT_EQ(judgement.arrived, false);
  EXPECT_FALSE(judgement.met);
}

TEST(SummarizeTest, CountsSharesAndFindsMedianAndWorst) {
  Results results;
  results.campaign.file = "f.yaml";
  results.campaign.samples = 4;
  results.rows = {
      Row(0, With({{"min_distance", 0.3}, {"final_error", 0.0}, {"limit_violations", 0.0}})),
      Row(1, With({{"min_distance", -0.1}, {"final_error", 0.0}, {"limit_violations", 3.0}})),
      Row(2, With({{"min_distance", 0.1}, {"final_error", 0.5}, {"limit_violations", 0.0}})),
      Row(3)};
  results.rows[2].unmet = {"final_error <= 0.1 (got 0.5)"};
  results.rows[3].outcome = Outcome::kFailed;
  results.rows[3].error = "lost";
  const Summary summary = Summarize(results);
  ASSERT_EQ(summary.combinations.size(), 1u);
  const CombinationSummary& one = summary.combinations[0];
  EXPECT_EQ(one.runs, 4);
  EXPECT_EQ(one.unfinished, 1);
  EXPECT_EQ(one.clear.count, 2);
  EXPECT_EQ(one.clear.of, 4);
  EXPECT_EQ(one.arrived.count, 2);
  EXPECT_EQ(one.both.count, 1);
  EXPECT_EQ(one.within_limits.count, 2);
  EXPECT_EQ(one.within_limits.of, 3);
  EXPECT_EQ(one.min_distance.count, 3);
  EXPECT_EQ(one.min_distance.median, 0.1);
  EXPECT_EQ(one.min_distance.worst, -0.1);
  EXPECT_EQ(one.min_distance.worst_sample, 1);
  EXPECT_EQ(one.final_error.worst, 0.5);
  EXPECT_EQ(summary.unfinished, 1);
  EXPECT_EQ(summary.unmet, 1);
  ASSERT_EQ(summary.failures.size(), 3u);
  EXPECT_EQ(summary.failures[0].why, "contact, -0.1 m");
  EXPECT_EQ(summary.failures[1].why, "not arrived, 0.5 off; not met: final_error <= 0.1 (got 0.5)");
  EXPECT_EQ(summary.failures[2].why, "failed: lost");
  EXPECT_EQ(summary.failures[2].command, "simulator run f.yaml --seed 0");
}

TEST(TitleOfTest, NamesSettingsByTheShortestEndOfThePathThatTellsThemApart) {
  EXPECT_EQ(TitleOf({}), "");
  EXPECT_EQ(TitleOf({{"parameters.avoid", "true"}, {"parameters.rate", "100"}}),
            "avoid=true rate=100");
  EXPECT_EQ(TitleOf({{"left.parameters.avoid", "true"}, {"right.parameters.avoid", "false"}}),
            "left.parameters.avoid=true right.parameters.avoid=false");
  EXPECT_EQ(TitleOf({{"avoid", "true"}, {"a.avoid", "false"}, {"b.avoid_not", "1"}}),
            "avoid=true a.avoid=false avoid_not=1");
}

}  // namespace summary_test
}  // namespace oca::sweep
