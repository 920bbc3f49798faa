// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/json_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace oca::models::internal {
namespace {

std::string Json(double number) {
  std::string out;
  AppendJson(out, number);
  return out;
}

TEST(JsonValuesTest, NumbersHaveTheFewestDigitsThatReadBack) {
  EXPECT_EQ(Json(0.1), "0.1");
  EXPECT_EQ(Json(-2.0), "-2");
  EXPECT_EQ(Json(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(Json(5e-324), "5e-324");
}

TEST(JsonValuesTest, ZeroKeepsItsSignWhereReadersTakeWholeNumbersApart) {
  EXPECT_EQ(Json(0.0), "0");
  EXPECT_EQ(Json(-0.0), "-0.0");
}

TEST(JsonValuesTest, WhatIsNotFiniteIsNull) {
  EXPECT_EQ(Json(std::nan("")), "null");
  EXPECT_EQ(Json(-std::numeric_limits<double>::infinity()), "null");
}

TEST(JsonValuesTest, TextIsEscapedAndBecomesUtf8) {
  std::string out;
  AppendQuoted(out, "a\"b\\c\nd\xFF");
  EXPECT_EQ(out, "\"a\\\"b\\\\c\\u000ad\xEF\xBF\xBD\"");
}

TEST(JsonValuesTest, AVectorIsAList) {
  std::string out;
  AppendList(out, {0.1, 0.0, -1e-9});
  EXPECT_EQ(out, "[0.1,0,-1e-09]");
}

}  // namespace
}  // namespace oca::models::internal
