// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace oca::robot {

/// The names in the URDF that an SRDF speaks of.
struct SrdfRobot {
  std::string name;
  std::vector<std::string> links, joints;
};

/// Pairs of links, as indices into `robot.links`, that an SRDF file excludes from collision checks:
/// <disable_collisions link1 link2>; and <disable_default_collisions link>, which excludes a link
/// from all pairs that no <enable_collisions link1 link2> brings back. The other elements of
/// MoveIt's format (groups, states, end effectors) are checked, not used: what they name must be
/// there.
///
/// throws ModelError naming file and line, with the nearest name: for an element or attribute that
///        is none of the format, as a misspelt one would leave a pair unchecked; for an unknown
///        link, joint or group; for the file of another robot; for xacro that was not expanded
/// source MoveIt, "URDF and SRDF"; srdfdom, src/model.cpp
std::vector<std::pair<int, int>> LoadDisabledPairs(const std::filesystem::path& file,
                                                   const SrdfRobot& robot);

/// An entry <disable_collisions link1 link2 reason>.
struct DisabledPair {
  std::string link1, link2;
  std::string reason;
};

/// Writes an SRDF file that disables `pairs`, in their order. Of a file that exists the pairs with
/// the reasons Adjacent, Always, Default and Never are replaced, and all else is kept: groups, states,
/// comments, and pairs that a person disabled for a reason of his own. The new file replaces the
/// old one at once or not at all.
/// throws ModelError if the file exists and is no SRDF of the robot `robot` (a URDF, say), or
/// cannot be written
void SaveDisabledPairs(const std::filesystem::path& file, const std::string& robot,
                       const std::vector<DisabledPair>& pairs);

}  // namespace oca::robot
