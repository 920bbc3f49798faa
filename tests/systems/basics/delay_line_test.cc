// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/delay_line.h"

#include <gtest/gtest.h>

#include <limits>

namespace oca::systems {
namespace delay_line_test {

using Eigen::Vector2d;

TEST(DelayLineTest, GivesBackTheOldestOfItsSamples) {
  DelayLine line;
  EXPECT_TRUE(line.empty());
  line.Fill(3, 2, Eigen::VectorXd(Vector2d(7.0, 8.0)));
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(Vector2d(line.oldest()), i < 3 ? Vector2d(7.0, 8.0) : Vector2d(i - 3, 3 - i)) << i;
    line.Push(Vector2d(i, -i));
  }
}

TEST(DelayLineTest, SaysWhetherASampleIsNotFinite) {
  DelayLine line;
  line.Fill(2, 2, Eigen::VectorXd(Vector2d(1.0, 2.0)));
  EXPECT_TRUE(Signal<DelayLine>::Check(line, Look::kFinite).ok());
  line.Push(Vector2d(1.0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(Signal<DelayLine>::Check(line, Look::kFinite).ok());
}

TEST(DelayLineTest, AScalarInitialValueCountsForEveryComponent) {
  DelayLine line;
  line.Fill(2, 3, 4.0);
  EXPECT_EQ(Eigen::VectorXd(line.oldest()), Eigen::VectorXd(Eigen::Vector3d(4.0, 4.0, 4.0)));
  EXPECT_EQ(line.values().size(), 6U);
}

}  // namespace delay_line_test
}  // namespace oca::systems
