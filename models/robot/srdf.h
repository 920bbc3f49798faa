// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// What an SRDF speaks of, as the URDF has it.
struct SrdfRobot {
  std::string name;
  std::vector<std::string> links, joints;
  std::vector<int> parents{};  ///< of each link, -1 of the root; empty: chains are not looked at
  /// Lower and upper limit of each joint, rad or m; empty: states are not looked at.
  std::vector<std::pair<double, double>> limits{};
};
SrdfRobot DescribeForSrdf(const std::string& name, std::span<const Link> links,
                          std::span<const Joint> joints);

/// A <group>: what it names itself, and the groups that it takes in.
struct SrdfGroup {
  struct Chain {
    std::string base_link, tip_link;
  };
  std::string name;
  std::vector<std::string> links{}, joints{}, groups{};
  std::vector<Chain> chains{};
};

/// What an SRDF file says of a robot.
struct Srdf {
  /// As indices into `SrdfRobot::links`, which are not checked for collision: those of
  /// <disable_collisions link1 link2>; and of <disable_default_collisions link>, which excludes a
  /// link from all pairs that no <enable_collisions link1 link2> brings back.
  std::vector<std::pair<int, int>> disabled_pairs{};
  std::vector<SrdfGroup> groups{};
  std::vector<NamedState> states{};    ///< of joints of the URDF that have one number
  std::vector<std::string> passive{};  ///< joints without a motor
  /// Frames that virtual joints stand the robot in, as `world`.
  std::vector<std::string> frames{};
  /// Lines on what its author hardly meant and nothing may need, one a kind: chains from tip to
  /// base or of one link, groups in a circle, pairs of a link with itself, states beyond limits.
  std::vector<std::string> warnings{};
};

inline constexpr int kDeepestGroups = 64;

/// Reads an SRDF file. The other elements of MoveIt's format (end effectors) are checked, not
/// used: what they name must be there.
///
/// throws ModelError naming file and line, with the nearest name: for an element or attribute that
///        is none of the format, as a misspelt one would leave a pair unchecked; for an unknown
///        link, joint or group; for a second group of a name, of which MoveIt drops one; for more
///        than kDeepestGroups in each other; for names with a line break; for the file of another
///        robot; for xacro that was not expanded
/// source MoveIt, "URDF and SRDF"; srdfdom, src/model.cpp
Srdf LoadSrdf(const std::filesystem::path& file, const SrdfRobot& robot);

/// An entry <disable_collisions link1 link2 reason>.
struct DisabledPair {
  std::string link1, link2;
  std::string reason;
};

/// Writes an SRDF file that disables `pairs`, in their order. Of a file that exists the pairs with
/// the reasons Adjacent, Always, Default and Never are replaced, and all else is kept: groups,
/// states, comments, and pairs that a person disabled for a reason of his own. The new file
/// replaces the old one at once or not at all.
/// throws ModelError if the file exists and is no SRDF of the robot `robot` (a URDF, say), or
/// cannot be written
void SaveDisabledPairs(const std::filesystem::path& file, const std::string& robot,
                       const std::vector<DisabledPair>& pairs);

}  // namespace oca::robot
