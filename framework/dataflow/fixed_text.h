// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Texts of fixed size, for source files; not for public headers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "oca/framework/dataflow/fault.h"

namespace oca {

/// What does not fit ends in "...".
template <std::size_t N>
void CopyText(std::string_view text, std::array<char, N>& to) {
  constexpr std::string_view kCut = "...";
  const std::size_t length = std::min(text.size(), N - 1);
  std::copy_n(text.data(), length, to.data());
  to[length] = '\0';
  if (length < text.size()) std::copy(kCut.begin(), kCut.end(), to.end() - 1 - kCut.size());
}

/// A fault with a text as of fmt::format, without the heap.
template <class... Args>
Fault FaultOf(fmt::format_string<Args...> format, Args&&... args) {
  std::array<char, 256> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), format, std::forward<Args>(args)...);
  return Fault({text.data(), std::min(end.size, text.size())});
}

}  // namespace oca
