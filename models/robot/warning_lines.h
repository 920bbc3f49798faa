// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "oca/models/counted.h"

namespace oca::robot {

/// What is odd in a description: a line a kind, for a terminal, and a line for each thing, which
/// can be shown where it is.
struct WarningLines {
  std::vector<std::string> sums{}, each{};
};

/// Of one kind: the sum is the first line `...; and 2 more links`.
inline WarningLines SummedUp(std::vector<std::string> each, const std::string& thing) {
  if (each.empty()) return {};
  const std::size_t more = each.size() - 1;
  std::string sum = each.front();
  if (more > 0) sum += "; and " + models::Counted(more, "more " + thing);
  return {{std::move(sum)}, std::move(each)};
}

}  // namespace oca::robot
