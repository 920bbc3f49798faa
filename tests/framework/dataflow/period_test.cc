// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/period.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "oca/framework/dataflow/error.h"

namespace oca {
namespace period_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(PeriodTest, FromSecondsFindsTheSimplestRatio) {
  EXPECT_EQ(Period::FromSeconds(0.01), Period(1, 100));
  EXPECT_EQ(Period::FromSeconds(1.0 / 60.0), Period(1, 60));
  EXPECT_EQ(Period::FromSeconds(0.1), Period(1, 10));
  EXPECT_EQ(Period::FromSeconds(0.3), Period(3, 10));
  EXPECT_EQ(Period::FromSeconds(1e-9), Period(1, 1000000000));
  EXPECT_EQ(Period::FromSeconds(0.005), Period(1, 200));
  EXPECT_EQ(Period::FromSeconds(1.0 / 3.0), Period(1, 3));
  EXPECT_EQ(Period::FromSeconds(0.123456789), Period(123456789, 1000000000));
  EXPECT_EQ(Period::FromSeconds(5.0), Period(5, 1));
  EXPECT_EQ(Period::FromSeconds(0.0), Period());
  EXPECT_EQ(Period::FromSeconds(-0.25), Period(-1, 4));
}

TEST(PeriodTest, ItsTicksAreRationalsAndNoSums) {
  const Period tenth(1, 10);
  double sum = 0.0;
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(tenth.seconds(k), k / 10.0);
    EXPECT_EQ(tenth.CountAt(k / 10.0), k);
    EXPECT_EQ(tenth.CountAt(std::nextafter(k / 10.0, -1.0)), k - 1);
    EXPECT_EQ(tenth.TickAfter(k / 10.0), (k + 1) / 10.0);
    sum += 0.1;
  }
  EXPECT_NE(sum, 100.0);  // what the above is good for
  EXPECT_NE(3 * 0.1, 0.3);
  EXPECT_EQ(Period(1, 60).CountAt(86400.0), 86400 * 60);
  EXPECT_EQ(tenth.CountAt(0.25), 2);
  EXPECT_EQ(tenth.CountAt(-0.25), -3);
  EXPECT_GT(tenth.CountAt(1e300), std::int64_t{1} << 52);
}

TEST(PeriodTest, FromSecondsForgivesOneRoundingInAFormula) {
  EXPECT_EQ(Period::FromSeconds(0.1 + 0.2), Period(3, 10));
  EXPECT_EQ(Period::FromSeconds(3 * 0.1), Period(3, 10));
}

TEST(PeriodTest, FromSecondsRefusesWhatIsNotARatioOfSmallIntegers) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e10, -1e10,
                           std::nextafter(1e9, kInfinity), 4e-10, 1e-300, std::sqrt(2.0)}) {
    EXPECT_THROW(Period::FromSeconds(bad), ConfigError) << bad;
  }
  EXPECT_EQ(Period::FromSeconds(1e9), Period(1000000000, 1));
}

TEST(PeriodTest, FromSecondsBringsEveryRatioOfModestIntegersBack) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> numerator(1, 100000), denominator(1, 1000000);
  for (int i = 0; i < 200000; ++i) {
    const std::int64_t p = numerator(random), q = denominator(random);
    const Period period = Period::FromSeconds(static_cast<double>(p) / static_cast<double>(q));
    ASSERT_EQ(period, Period(p, q)) << p << "/" << q;
  }
}

TEST(PeriodTest, FromSecondsBringsNanosecondsBack) {
  std::mt19937_64 random(8);
  std::uniform_int_distribution<std::int64_t> nanoseconds(1, 1000000000);
  for (int i = 0; i < 200000; ++i) {
    const std::int64_t n = nanoseconds(random);
    ASSERT_EQ(Period::FromSeconds(static_cast<double>(n) / 1e9), Period(n, 1000000000)) << n;
  }
}

TEST(PeriodTest, IsInLowestTerms) {
  EXPECT_EQ(Period(10, 40).numerator(), 1);
  EXPECT_EQ(Period(10, 40).denominator(), 4);
  EXPECT_EQ(Period(-10, 40), Period(-1, 4));
  EXPECT_EQ(Period(0, 5), Period());
}

TEST(PeriodTest, RefusesADenominatorThatIsNotPositive) {
  EXPECT_THROW(Period(1, 0), ConfigError);
  EXPECT_THROW(Period(1, -1), ConfigError);
  EXPECT_NO_THROW(Period(1, 1));
}

TEST(PeriodTest, IsPositiveAboveZeroOnly) {
  EXPECT_TRUE(Period(1, 1000000000).positive());
  EXPECT_FALSE(Period().positive());
  EXPECT_FALSE(Period(-1, 10).positive());
}

TEST(PeriodTest, ReadsAsADecimalWhereItIsOne) {
  EXPECT_EQ(Period(1, 100).ToString(), "0.01 s");
  EXPECT_EQ(Period(3, 8).ToString(), "0.375 s");
  EXPECT_EQ(Period(2, 1).ToString(), "2 s");
  EXPECT_EQ(Period(1, 60).ToString(), "1/60 s");
}

}  // namespace period_test
}  // namespace oca
