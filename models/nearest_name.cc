// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/nearest_name.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace oca::models {

int EditDistance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string NearestName(std::string_view name, std::span<const std::string> candidates) {
  // Suggesting for a text of book length would take longer than it helps.
  constexpr std::size_t kLongest = 200;
  std::string nearest;
  int least = std::numeric_limits<int>::max();
  for (const std::string& candidate : candidates) {
    const int distance =
        EditDistance(name.substr(0, kLongest), std::string_view(candidate).substr(0, kLongest));
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace oca::models
