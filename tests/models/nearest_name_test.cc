// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace oca::models::test {
namespace nearest_name_test {

TEST(NearestNameTest, DistanceCountsInsertionsRemovalsAndReplacements) {
  EXPECT_EQ(EditDistance("", ""), 0);
  EXPECT_EQ(EditDistance("", "abc"), 3);
  EXPECT_EQ(EditDistance("abc", ""), 3);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("abc", "abc"), 0);
}

TEST(NearestNameTest, PicksTheClosestAndTheFirstOfEquals) {
  const std::vector<std::string> names{"elbow", "wrist_1", "wrist_2"};
  EXPECT_EQ(NearestName("elbw", names), "elbow");
  EXPECT_EQ(NearestName("wrist", names), "wrist_1");
  EXPECT_EQ(NearestName("anything", {}), "");
}

}  // namespace nearest_name_test
}  // namespace oca::models::test
