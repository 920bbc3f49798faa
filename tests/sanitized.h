// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Whether this is built with a sanitizer that brings a malloc of its own and makes all slow; GCC
/// and Clang say so differently.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define OCA_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define OCA_SANITIZED 1
#endif
#endif
#ifndef OCA_SANITIZED
#define OCA_SANITIZED 0
#endif

namespace oca {
inline constexpr bool kSanitized = OCA_SANITIZED == 1;
/// How many of so many random cases there is time for.
constexpr int Fewer(int count) { return kSanitized ? count / 20 : count; }
}  // namespace oca
