// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "oca/models/error.h"

class TiXmlElement;

namespace oca::robot {

/// What a URDF file says about its tree, in the order of the file, with line numbers; the numbers
/// in it are taken from urdfdom, which keeps neither order nor lines and drops what it cannot read.
struct UrdfOutline {
  /// A <collision> or <visual>.
  struct Element {
    int line{0};
    std::string mesh{};  // its file name; empty: it is no mesh
  };
  struct Link {
    std::string name;
    int line{0};
    std::vector<Element> collisions, visuals;
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

/// Reads the outline below `root`, of a document that is repaired (RepairUrdf), and refuses what
/// urdfdom would drop, misread or accept in silence: unexpanded xacro, unknown or repeated
/// elements, unknown geometry, numbers that are missing or not finite, sizes that are not positive,
/// a zero axis, limits that are missing or reversed, repeated names. `where` names the file in
/// messages, each of which names line and element. With errors the outline is incomplete.
/// throws ModelError at once if it is no robot or a xacro
UrdfOutline ReadUrdfOutline(const TiXmlElement& root, const std::string& where,
                            models::ModelErrors& errors);

/// Refuses references to unknown links or joints, a link with two parents, two roots and loops, of
/// the tree and of mimic rules, and mimics of fixed joints.
void CheckUrdfTree(const UrdfOutline& outline, const std::string& where,
                   models::ModelErrors& errors);

/// How links and joints of a sound tree are numbered: depth first, children in the order of the
/// file's joints.
struct UrdfOrder {
  std::vector<std::size_t> links, joints;  ///< places in the outline
  std::unordered_map<std::string, int> number_of_link, number_of_joint;
};
UrdfOrder OrderUrdf(const UrdfOutline& outline);

}  // namespace oca::robot
