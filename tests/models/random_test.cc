// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/random.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace oca::models {
namespace random_test {

TEST(RandomTest, IsSplitMix64) {
  // The first outputs of the published algorithm for seed 1234567.
  Random random(1234567);
  EXPECT_EQ(random.Bits(), 6457827717110365317u);
  EXPECT_EQ(random.Bits(), 3203168211198807973u);
  EXPECT_EQ(random.Bits(), 9817491932198370423u);
}

TEST(RandomTest, UnitStaysBelowOneAndFillsTheInterval) {
  Random random(1);
  std::array<int, 10> tenths{};
  for (int i = 0; i < 10000; ++i) {
    const double unit = random.Unit();
    ASSERT_GE(unit, 0.0);
    ASSERT_LT(unit, 1.0);
    ++tenths[static_cast<std::size_t>(unit * 10.0)];
  }
  for (const int count : tenths) EXPECT_NEAR(count, 1000, 150);  // 5 sigma
}

TEST(RandomTest, BelowReachesAllNumbersAndNoOther) {
  Random random(2);
  std::set<std::uint64_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random.Below(7));
  EXPECT_EQ(seen, (std::set<std::uint64_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(random.Below(1), 0u);
}

TEST(RandomTest, SeedsOfNeighboursAndNamesDiffer) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (std::uint64_t which = 0; which < 100; ++which) seeds.insert(Random::Seed(seed, which));
    seeds.insert(Random::Seed(seed, "a"));
    seeds.insert(Random::Seed(seed, "b"));
  }
  EXPECT_EQ(seeds.size(), 10200u);
}

}  // namespace random_test
}  // namespace oca::models
