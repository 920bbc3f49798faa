// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/edit_distance.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

TEST(EditDistanceTest, TheNearestIsTheFirstOfEqualsByTheFirst200Characters) {
  const std::vector<std::string> names{"elbow", "wrist_1", "wrist_2"};
  EXPECT_EQ(NearestOf("wrist", names).candidate, &names[1]);
  EXPECT_EQ(NearestOf("wrist", names).distance, 2u);
  EXPECT_EQ(NearestOf("wrist", {}).candidate, nullptr);
  const std::vector<std::string> huge{std::string(200, 'a') + "b"};
  EXPECT_EQ(NearestOf(std::string(200, 'a') + "ccc", huge).distance, 0u);
  EXPECT_EQ(NearestOf(std::string(199, 'a') + "ccc", huge).distance, 1u);
}

}  // namespace edit_distance_test
}  // namespace oca::internal
