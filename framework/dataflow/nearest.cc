// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace oca {
namespace {

/// Optimal string alignment distance (Damerau-Levenshtein without repeated edits).
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before = last;
    last = row;
  }
  return last.back();
}

}  // namespace

std::string DidYouMean(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > 200) return "";
  const std::string* best = nullptr;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = EditDistance(word, candidate);
    if (best == nullptr || distance < best_distance) {
      best = &candidate;
      best_distance = distance;
    }
  }
  const bool near = best != nullptr && best_distance > 0 &&
                    best_distance <= std::max<std::size_t>(2, word.size() / 3) &&
                    best_distance < word.size();
  return near ? fmt::format("; did you mean '{}'?", *best) : "";
}

}  // namespace oca
