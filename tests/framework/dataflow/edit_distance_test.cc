// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/edit_distance.h"

#include <gtest/gtest.h>

namespace oca::internal {
namespace edit_distance_test {

TEST(EditDistanceTest, CountsInsertionsRemovalsAndReplacements) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("abc", ""), 3u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(EditDistance("abc", "abc"), 0u);
}

TEST(EditDistanceTest, CountsASwapOfNeighboursOnceAndEditsNothingTwice) {
  EXPECT_EQ(EditDistance("ab", "ba"), 1u);
  EXPECT_EQ(EditDistance("velcoity", "velocity"), 1u);
  EXPECT_EQ(EditDistance("abcd", "badc"), 2u);
  EXPECT_EQ(EditDistance("ca", "abc"), 3u);  // a swap and an insertion between would be 2
}

}  // namespace edit_distance_test
}  // namespace oca::internal
