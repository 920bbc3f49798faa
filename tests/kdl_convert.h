// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <kdl/frames.hpp>

namespace oca::test {

/// Eigen's vectors and poses as those of Orocos KDL.
inline KDL::Vector ToKdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline KDL::Frame ToKdl(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                        R(2, 2)),
          ToKdl(X.translation())};
}

}  // namespace oca::test
