// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/nearest.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/edit_distance.h"

namespace oca {

std::string DidYouMean(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > 200) return "";
  const auto [best, distance] = internal::NearestOf(word, candidates);
  const bool near = best != nullptr && distance > 0 &&
                    distance <= std::max<std::size_t>(2, word.size() / 3) && distance < word.size();
  return near ? fmt::format("; did you mean '{}'?", *best) : "";
}

}  // namespace oca
