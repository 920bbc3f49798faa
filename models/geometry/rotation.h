// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

namespace oca::geometry {

/// Rotation by roll, pitch, yaw (rad) about the fixed axes x, y, z in this order, as in URDF:
/// R = R_z(yaw) R_y(pitch) R_x(roll).
Eigen::Quaterniond FromRollPitchYaw(const Eigen::Vector3d& rpy);

/// The rotation of [x, y, z, w], which may be off unit length by rounding to three digits.
/// throws ModelError naming `where` for other lengths
Eigen::Quaterniond FromQuaternion(const Eigen::Vector4d& xyzw, const std::string& where);

/// throws ModelError naming `where` unless the length is 1 to within rounding to three digits
Eigen::Vector3d CheckedUnitVector(const Eigen::Vector3d& vector, const std::string& where);

}  // namespace oca::geometry
