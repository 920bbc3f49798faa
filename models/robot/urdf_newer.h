// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "oca/models/error.h"

class TiXmlElement;

namespace oca::robot {

/// What a document of URDF 1.1 had that URDF 1.0, which urdfdom 3 reads, has no word for.
struct NewerUrdf {
  bool changed{false};
  std::set<const TiXmlElement*> capsules{};  ///< <collision> and <visual> elements

  /// Whether number `place` of the <collision> or <visual> elements (`kind`) of a link is one.
  bool IsCapsule(const TiXmlElement& root, const std::string& kind, const std::string& link,
                 std::size_t place) const;
};

/// Says a URDF document, below `root`, in the words of URDF 1.0: `quat_xyzw` of <origin> becomes
/// rpy, <capsule radius length> a cylinder of these (a sphere, if it has no length), and version
/// 1.1 version 1.0.
/// Into `errors` goes, with file, `where`, and line, another version. Quaternions and capsules that
/// are none stay, for RepairUrdf to take out where they are only drawn, else for ReadUrdfOutline to
/// refuse.
/// source ros/urdfdom, pull requests 235 (quaternions) and 238 (capsules): `length` is that of the
///        part between the half spheres
NewerUrdf RewriteNewerUrdf(TiXmlElement& root, const std::string& where,
                           models::ModelErrors& errors);

}  // namespace oca::robot
