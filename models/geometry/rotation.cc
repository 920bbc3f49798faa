// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/rotation.h"

#include <fmt/format.h>

#include <cmath>

#include "oca/models/error.h"

namespace oca::geometry {
namespace {

// Four numbers rounded to three digits are off by 0.0005 each, so their length by 0.001.
constexpr double kLengthRounding = 1e-3;

void CheckLength(double length, const std::string& where, const char* expected) {
  if (std::fabs(length - 1.0) <= kLengthRounding) return;
  throw models::ModelError(fmt::format("{}: length; got {}; expected {}", where, length, expected));
}

}  // namespace

Eigen::Quaterniond FromRollPitchYaw(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd;
  return Eigen::Quaterniond(AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                            AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                            AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
}

Eigen::Quaterniond FromQuaternion(const Eigen::Vector4d& xyzw, const std::string& where) {
  CheckLength(xyzw.norm(), where, "1, a unit quaternion [x, y, z, w]");
  return Eigen::Quaterniond(xyzw).normalized();
}

Eigen::Vector3d CheckedUnitVector(const Eigen::Vector3d& vector, const std::string& where) {
  CheckLength(vector.norm(), where, "1, a unit vector");
  return vector.normalized();
}

}  // namespace oca::geometry
