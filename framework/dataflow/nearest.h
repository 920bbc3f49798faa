// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace oca {

/// `; did you mean 'x'?` for the candidate nearest to `word` by edit distance (transpositions
/// count once), or nothing if none is near.
std::string DidYouMean(std::string_view word, std::span<const std::string> candidates);

}  // namespace oca
