// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace oca::models {

/// Least number of inserted, removed or replaced characters between two texts (Levenshtein 1966).
int EditDistance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance to `name`, the first of equals; "" if none.
std::string NearestName(std::string_view name, std::span<const std::string> candidates);

}  // namespace oca::models
