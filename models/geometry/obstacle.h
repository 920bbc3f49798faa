// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "oca/models/geometry/collider.h"
#include "oca/models/name.h"

namespace oca::geometry {

/// What an obstacle is, apart from where it is: shared by all its samples.
struct ObstacleBody {
  models::Name id{};
  std::shared_ptr<const Collider> collider{};
  std::string file{};  ///< of a mesh, as the user wrote it
  /// No point of it is ever faster, m/s; 0 if nothing is known beyond its present velocity.
  double fastest{0.0};
};

/// An obstacle at one instant. `linear` and `angular` velocity (m/s, rad/s) are those of its
/// origin.
struct Obstacle {
  std::shared_ptr<const ObstacleBody> body{};
  Eigen::Isometry3d X_WO{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};

  /// Velocity of the point of the obstacle that is now at p_W, m/s.
  Eigen::Vector3d VelocityAt(const Eigen::Vector3d& p_W) const {
    return linear + angular.cross(p_W - X_WO.translation());
  }
};

}  // namespace oca::geometry
