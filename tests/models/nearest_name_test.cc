// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace oca::models {
namespace nearest_name_test {

TEST(NearestNameTest, PicksTheClosestAndTheFirstOfEquals) {
  const std::vector<std::string> names{"elbow", "wrist_1", "wrist_2"};
  EXPECT_EQ(NearestName("elbw", names), "elbow");
  EXPECT_EQ(NearestName("wrist", names), "wrist_1");
  EXPECT_EQ(NearestName("anything", {}), "");
  const std::vector<std::string> swapped{"nmes", "name"};
  EXPECT_EQ(NearestName("nmae", swapped), "name");  // one swap, not two replacements
}

TEST(MisspeltNameTest, IsTheNearestWithinTwoEditsAndNeverTheNameItself) {
  const std::vector<std::string> names{"velocity", "effort"};
  EXPECT_EQ(MisspeltName("velcoity", names), "velocity");
  EXPECT_EQ(MisspeltName("vlcity", names), "velocity");  // 2 removed
  EXPECT_EQ(MisspeltName("vlcty", names), "");           // 3
  EXPECT_EQ(MisspeltName("effort", names), "");
  EXPECT_EQ(MisspeltName("ab", {}), "");
}

}  // namespace nearest_name_test
}  // namespace oca::models
