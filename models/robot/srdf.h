// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace oca::models {

/// Pairs of links, as indices into `links`, that an SRDF file excludes from collision checks:
/// <disable_collisions link1 link2>; and <disable_default_collisions link>, which excludes a link
/// from all pairs that no <enable_collisions link1 link2> brings back. Other elements of MoveIt's
/// format (groups, states, end effectors) are not read.
/// throws ModelError naming file and line, for an unknown link with the nearest name
std::vector<std::pair<int, int>> LoadDisabledPairs(const std::filesystem::path& file,
                                                   const std::vector<std::string>& links);

}  // namespace oca::models
