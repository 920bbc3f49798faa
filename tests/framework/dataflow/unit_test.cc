// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "oca/framework/dataflow/port.h"

namespace oca {
namespace unit_test {

TEST(UnitTest, IsTheSameHoweverItsRatesAreWritten) {
  EXPECT_EQ(Unit("rad/s^2"), Unit("rad").Rate().Rate());
  EXPECT_EQ(Unit("rad/s").Rate(), Unit("rad/s^2"));
  EXPECT_EQ(Unit("m/s^3").Rate(-3), Unit("m"));
  EXPECT_NE(Unit("rad"), Unit("rad/s"));
  EXPECT_NE(Unit("N s/m"), Unit("N"));
}

TEST(UnitTest, IsShownAsPeopleWriteIt) {
  EXPECT_EQ(Unit("rad").ToString(), "rad");
  EXPECT_EQ(Unit("rad").Rate().ToString(), "rad/s");
  EXPECT_EQ(Unit("rad/s").Rate().ToString(), "rad/s^2");
  EXPECT_EQ(Unit("rad/s^2").Rate().ToString(), "rad/s^3");
  EXPECT_EQ(Unit("rad").Rate(-1).ToString(), "rad s");
  EXPECT_EQ(Unit("rad").Rate(-2).ToString(), "rad s^2");
  EXPECT_EQ(Unit::Variable(3).Rate().ToString(), "u/s");
  EXPECT_EQ(Unit::Any().ToString(), "");
}

TEST(UnitTest, AnyIsAnyHoweverOftenItIsTakenPerSecond) {
  EXPECT_TRUE(Unit::Any().Rate().any());
  EXPECT_EQ(Unit::Any().Rate().ToString(), "");
  EXPECT_FALSE(Unit("/s").any());  // no base: a text like any other
  EXPECT_EQ(Unit("/s").ToString(), "/s");
  EXPECT_FALSE(Unit::Variable(0).any());
}

}  // namespace unit_test
}  // namespace oca
