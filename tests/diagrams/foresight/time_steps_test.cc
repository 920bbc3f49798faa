// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/time_steps.h"

#include <gtest/gtest.h>

namespace oca::foresight {
namespace time_steps_test {

TEST(TimeStepsTest, AreMillisecondsOfAShortRun) {
  const TimeSteps steps(0.01);
  EXPECT_EQ(steps.size(), 11);
  EXPECT_DOUBLE_EQ(steps[0], 0.0);
  EXPECT_DOUBLE_EQ(steps[7], 0.007);
  EXPECT_EQ(TimeSteps(0.0).size(), 1);
  EXPECT_EQ(TimeSteps(200.0).size(), 200'001);
  EXPECT_DOUBLE_EQ(TimeSteps(200.0)[200'000], 200.0);
}

TEST(TimeStepsTest, OfALongRunAreBoundedAndGrowInProportionToItsEnd) {
  for (const double duration : {200.5, 300.0, 1e4, 1e7}) {
    const TimeSteps steps(duration);
    ASSERT_LE(steps.size(), 300'001) << duration;
    EXPECT_NEAR(steps[steps.size() - 1], duration, 1e-9 * duration);
    double last = steps[0];
    for (long k = 1; k < steps.size(); ++k) {
      ASSERT_GT(steps[k], last) << duration;
      // ln(1e7 / 200) / 100000 = 1.0820e-4 of the time, by hand.
      ASSERT_LT(steps[k] - last, 1.0822e-4 * steps[k] + 1.0001e-3) << duration;
      last = steps[k];
    }
  }
}

}  // namespace time_steps_test
}  // namespace oca::foresight
