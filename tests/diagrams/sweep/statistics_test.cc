// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/statistics.h"

#include <gtest/gtest.h>

#include <numeric>

#include "oca/diagrams/sweep/step_times.h"

namespace oca::sweep {
namespace statistics_test {

// Newcombe, Two-sided confidence intervals for the single proportion, Stat. Med. 17, 1998, table I,
// method 3.
TEST(WilsonIntervalTest, GivesThePublishedValues) {
  const struct {
    std::size_t count, of;
    double low, high;
  } published[] = {{81, 263, 0.2553, 0.3662},
                   {15, 148, 0.0624, 0.1605},
                   {0, 20, 0.0, 0.1611},
                   {1, 29, 0.0061, 0.1718}};
  for (const auto& [count, of, low, high] : published) {
    const ConfidenceInterval interval = WilsonInterval(count, of);
    EXPECT_NEAR(interval.low, low, 5e-5) << count << " of " << of;
    EXPECT_NEAR(interval.high, high, 5e-5) << count << " of " << of;
  }
}

TEST(WilsonIntervalTest, EndsAtNoneAndAtAllAndKnowsNothingOfNoSamples) {
  EXPECT_EQ(WilsonInterval(0, 300).low, 0.0);
  EXPECT_EQ(WilsonInterval(300, 300).high, 1.0);
  EXPECT_NEAR(WilsonInterval(300, 300).low, 1.0 - WilsonInterval(0, 300).high, 1e-12);
  EXPECT_EQ(WilsonInterval(0, 0).low, 0.0);
  EXPECT_EQ(WilsonInterval(0, 0).high, 1.0);
}

TEST(QuantileTest, InterpolatesBetweenTheSortedValues) {
  EXPECT_EQ(Quantile({3.0}, 0.5), 3.0);
  EXPECT_EQ(Quantile({1.0, 2.0}, 0.5), 1.5);
  EXPECT_EQ(Quantile({1.0, 2.0, 4.0}, 0.75), 3.0);
  EXPECT_EQ(Quantile({1.0, 2.0, 4.0}, 1.0), 4.0);
}

// The ranks of Conover's and others' tables: 9 values 2nd to 8th, 20 values 6th to 15th, 100 values
// 40th to 61st.
TEST(MedianIntervalTest, TakesTheRanksOfTheTables) {
  const struct {
    int n;
    double low, high;
  } tables[] = {{1, 1, 1}, {5, 1, 5}, {6, 1, 6}, {9, 2, 8}, {20, 6, 15}, {100, 40, 61}};
  for (const auto& [n, low, high] : tables) {
    std::vector<double> values(static_cast<std::size_t>(n));
    std::iota(values.begin(), values.end(), 1.0);
    EXPECT_EQ(MedianInterval(values).low, low) << n;
    EXPECT_EQ(MedianInterval(values).high, high) << n;
  }
}

TEST(StepTimesTest, FindsQuantilesToOnePerCentAndAddsUp) {
  StepTimes one, other;
  for (int i = 1; i <= 500; ++i) one.Add(1e-6 * i);
  for (int i = 501; i <= 1000; ++i) other.Add(1e-6 * i);
  one.Add(other);
  EXPECT_EQ(one.count(), 1000);
  EXPECT_NEAR(one.Quantile(0.5), 500e-6, 6e-6);
  EXPECT_NEAR(one.Quantile(0.99), 990e-6, 11e-6);
  EXPECT_EQ(one.max(), 1000e-6);
  EXPECT_EQ(StepTimes().Quantile(0.5), 0.0);
}

}  // namespace statistics_test
}  // namespace oca::sweep
