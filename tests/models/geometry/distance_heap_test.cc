// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/models/geometry/random_bodies.h"

namespace {
std::atomic<long> g_allocations{0};
}  // namespace

// Not inlined: GCC would take malloc and delete for a mismatched pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++g_allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(step, (size + step - 1) / step * step)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace oca::models {
namespace {

TEST(DistanceHeapTest, NoQueryAllocates) {
  RandomBodies random(31);
  long queries = 0, overlaps = 0;
  for (int i = 0; i < 3'000; ++i) {
    const auto a = random.Body(random.Integer(RandomBodies::kKinds)),
               b = random.Body(random.Integer(RandomBodies::kKinds));
    const bool grid = i % 2 == 0;
    const auto X_WA = grid ? random.GridPose() : random.Pose(0.3);
    const auto X_WB = grid ? random.GridPose() : random.Pose(0.3);
    PairCache cache;
    const long before = g_allocations;
    const auto cold = Distance(*a, X_WA, *b, X_WB, 1.0, &cache);
    const auto warm = Distance(*a, X_WA, *b, X_WB, 1.0, &cache);
    ASSERT_EQ(g_allocations, before) << KindName(*a) << " and " << KindName(*b);
    queries += 2;
    overlaps += cold.distance < 0.0 && warm.distance < 0.0;
  }
  EXPECT_EQ(queries, 6'000);
  EXPECT_GT(overlaps, 500);
}

TEST(DistanceHeapTest, TheCounterCounts) {
  const long before = g_allocations;
  const auto body = MakeCollider(Sphere{1.0}, "ball");
  EXPECT_GT(g_allocations, before);
}

}  // namespace
}  // namespace oca::models
