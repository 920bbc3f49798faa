// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/counted.h"

#include <gtest/gtest.h>

namespace oca::models {
namespace {

TEST(CountedTest, OneIsOne) {
  EXPECT_EQ(Counted(0, "more link"), "0 more links");
  EXPECT_EQ(Counted(1, "more link"), "1 more link");
  EXPECT_EQ(Counted(2, "more link"), "2 more links");
}

}  // namespace
}  // namespace oca::models
