// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/allocation_count.h"

#include <atomic>
#include <cstdlib>

namespace {
std::atomic<std::int64_t> allocations{0};
}

// glibc's own entry points: everything that allocates ends there, SUNDIALS included.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_memalign(alignment, size);
}
}

namespace oca::bench {

std::int64_t AllocationCount() { return allocations.load(std::memory_order_relaxed); }

}  // namespace oca::bench
