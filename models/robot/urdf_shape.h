// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "oca/models/robot/xml_reader.h"

namespace oca::robot {

/// Refuses an <origin> of a joint, a <collision> or a <visual> that is no place and turn in the
/// words of URDF 1.0 or 1.1 (`quat_xyzw`), or that lies farther away than a double can place to
/// 1e-10 m (visuals: anywhere).
/// throws ModelError
void CheckUrdfOrigin(const XmlReader& xml, const TiXmlElement& parent);

/// The unit quaternion of an <origin> that says `quat_xyzw`. throws ModelError
Eigen::Quaterniond UrdfQuaternion(const XmlReader& xml, const TiXmlElement& origin);

/// Refuses sizes of a <capsule> that are none. throws ModelError
void CheckUrdfCapsule(const XmlReader& xml, const TiXmlElement& capsule);

/// Refuses a <collision> or <visual> without one shape that URDF 1.0 or 1.1 (<capsule>) has and
/// what that needs.
/// Returns the file of a mesh, "" for other shapes.
/// throws ModelError
std::string CheckUrdfGeometry(const XmlReader& xml, const TiXmlElement& solid);

}  // namespace oca::robot
