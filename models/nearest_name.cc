// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/nearest_name.h"

#include <cstddef>
#include <limits>

#include "oca/framework/dataflow/edit_distance.h"

namespace oca::models {

std::string NearestName(std::string_view name, std::span<const std::string> candidates) {
  // Suggesting for a text of book length would take longer than it helps.
  constexpr std::size_t kLongest = 200;
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : candidates) {
    const std::size_t distance = oca::internal::EditDistance(
        name.substr(0, kLongest), std::string_view(candidate).substr(0, kLongest));
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace oca::models
