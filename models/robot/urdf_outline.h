// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

class TiXmlElement;

namespace oca::robot {

/// What a URDF file says about its tree, in the order of the file, with line numbers; the numbers
/// in it are taken from urdfdom, which keeps neither order nor lines and drops what it cannot read.
struct UrdfOutline {
  struct Link {
    std::string name;
    int line{0};
    std::vector<int> collision_lines;
    std::vector<int> visual_lines;
  };
  struct Joint {
    std::string name, parent, child;
    std::string mimic;  // empty: none
    int line{0};
    bool fixed{false};
    std::optional<double> acceleration, jerk;  // <limit acceleration jerk>, which urdfdom 3 skips
  };
  std::string robot_name;
  std::vector<Link> links;
  std::vector<Joint> joints;
};

/// Reads the outline below `root`, of a document that is repaired (RepairUrdf), and refuses what urdfdom would drop, misread or accept in
/// silence: unexpanded xacro, unknown or repeated elements, unknown geometry, numbers that are
/// missing or not finite, sizes that are not positive, a zero axis, limits that are missing or
/// reversed, repeated names. `where` names the file in messages.
/// throws ModelError naming file, line and element
UrdfOutline ReadUrdfOutline(const TiXmlElement& root, const std::string& where);

/// Refuses references to unknown links or joints, a link with two parents, two roots and loops, of
/// the tree and of mimic rules, and mimics of fixed joints. throws ModelError
void CheckUrdfTree(const UrdfOutline& outline, const std::string& where);

}  // namespace oca::robot
