// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace oca::internal {

/// Least number of characters inserted, removed, replaced or swapped with their neighbour between
/// two texts, none of them edited twice. In a header, as error_base.h is, for models suggest names
/// too.
/// source Damerau 1964, Comm. ACM 7; optimal string alignment
inline std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last.back();
}

/// A candidate and its EditDistance to what was asked for.
struct NearestCandidate {
  const std::string* candidate{nullptr};  ///< none if there was none
  std::size_t distance{0};
};

/// The first of those nearest to `name`. All count by their first 200 characters: a text of book
/// length would take longer than it helps.
inline NearestCandidate NearestOf(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kLongest = 200;
  NearestCandidate nearest;
  for (const std::string& candidate : candidates) {
    const std::size_t distance =
        EditDistance(name.substr(0, kLongest), std::string_view(candidate).substr(0, kLongest));
    if (nearest.candidate == nullptr || distance < nearest.distance) {
      nearest = {&candidate, distance};
    }
  }
  return nearest;
}

}  // namespace oca::internal
