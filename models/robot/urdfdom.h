// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <urdf_model/model.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Parses URDF text with urdfdom, which prints nothing meanwhile. It drops in silence what it does
/// not know: see ReadUrdfOutline. Safe to call from several threads, one of which then waits.
/// throws ModelError with what urdfdom would have printed as an error; `where` names the file
std::shared_ptr<urdf::ModelInterface> ParseWithUrdfdom(const std::string& text,
                                                       const std::string& where);

// What it read, as ours.
Eigen::Isometry3d ToPose(const urdf::Pose& pose);
Eigen::Vector3d ToVector(const urdf::Vector3& v);
/// Of a sphere, a box or a cylinder.
geometry::Shape ToPrimitive(const urdf::Geometry& geometry);
/// A cylinder as the capsule of the same length between its centres.
geometry::Shape CapsuleOf(const geometry::Shape& shape);
Inertia ToInertia(const urdf::Inertial& from);

}  // namespace oca::robot
