// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tests/sanitized.h"

namespace oca {

/// Whether a program that has allocation_count.cc among its sources counts; sanitizers bring a
/// malloc of their own.
#if defined(__GLIBC__) && !OCA_SANITIZED
inline constexpr bool kCountsAllocations = true;
#else
inline constexpr bool kCountsAllocations = false;
#endif

/// Calls of malloc and its kin by this thread so far, which is where operator new, Eigen and
/// SUNDIALS take their memory too.
std::int64_t AllocationCount();

}  // namespace oca
