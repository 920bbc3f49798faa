// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/allocation_count.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace distance_heap_test {

TEST(DistanceHeapTest, NoQueryAllocates) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  RandomBodies random(31);
  long queries = 0, overlaps = 0;
  for (int i = 0; i < 3'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const bool grid = i % 2 == 0;
    const auto X_WA = grid ? random.GridPose() : random.Pose(0.3);
    const auto X_WB = grid ? random.GridPose() : random.Pose(0.3);
    PairCache cache;
    const long before = AllocationCount();
    const auto cold = Distance(*a, X_WA, *b, X_WB, 1.0, &cache);
    const auto warm = Distance(*a, X_WA, *b, X_WB, 1.0, &cache);
    ASSERT_EQ(AllocationCount(), before) << KindName(*a) << " and " << KindName(*b);
    queries += 2;
    overlaps += cold.distance < 0.0 && warm.distance < 0.0;
  }
  EXPECT_EQ(queries, 6'000);
  EXPECT_GT(overlaps, 500);
}

TEST(DistanceHeapTest, TheCounterCounts) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const long before = AllocationCount();
  const auto body = MakeCollider(Sphere{1.0}, "ball");
  EXPECT_GT(AllocationCount(), before);
}

}  // namespace distance_heap_test
}  // namespace oca::geometry
