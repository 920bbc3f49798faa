// SPDX-License-Identifier: BSD-3-Clause
#include "tests/allocation_count.h"

#include <cstddef>
#include <cstdlib>

namespace {
thread_local std::int64_t allocations = 0;
}

namespace oca {
std::int64_t AllocationCount() { return allocations; }
}  // namespace oca

#if defined(__GLIBC__) && !OCA_SANITIZED
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) {
  ++allocations;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  ++allocations;
  return __libc_calloc(count, bytes);
}
void* realloc(void* memory, std::size_t bytes) {
  ++allocations;
  return __libc_realloc(memory, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  ++allocations;
  return __libc_memalign(alignment, bytes);
}
}
#endif
