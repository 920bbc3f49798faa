// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/nearest.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/edit_distance.h"

namespace oca {

std::string DidYouMean(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > 200) return "";
  const std::string* best = nullptr;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = internal::EditDistance(word, candidate);
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
