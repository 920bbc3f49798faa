// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace oca::robot {

/// What is odd in a description: a line a kind, for a terminal, and a line for each thing, which
/// can be shown where it is.
struct WarningLines {
  std::vector<std::string> sums{}, each{};
};

/// Of one kind: the sum is the first line `...; and 2 more links`.
WarningLines SummedUp(std::vector<std::string> each, const std::string& thing);

struct LinkWarning {
  std::string link{}, line{};
};

/// Of one kind: the sum is the first line `...; and 3 more, of links 'b', 'c'`.
WarningLines SummedUpByLink(const std::vector<LinkWarning>& all);

}  // namespace oca::robot
