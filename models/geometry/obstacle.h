// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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
/// origin; where nobody knows them, `velocity_known` is false and they are 0, which says nothing.
struct Obstacle {
  std::shared_ptr<const ObstacleBody> body{};
  Eigen::Isometry3d X_WO{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};
  bool velocity_known{true};

  /// Velocity of the point of the obstacle that is now at p_W, m/s.
  Eigen::Vector3d VelocityAt(const Eigen::Vector3d& p_W) const {
    return linear + angular.cross(p_W - X_WO.translation());
  }
};

/// How well an obstacle is known whose state was estimated.
struct ObstacleEstimate {
  using Covariance = Eigen::Matrix<double, 6, 6>;
  Eigen::Vector3d acceleration{Eigen::Vector3d::Zero()};  ///< of the origin, m/s^2
  /// Of the errors of position (m) and linear velocity (m/s), in this order, world axes.
  Covariance covariance{Covariance::Zero()};
  double age{0.0};  ///< s; since the last pose that it rests upon

  /// Covariance of the position, m^2, `ahead` s later, if its velocity goes on.
  Eigen::Matrix3d PositionCovariance(double ahead = 0.0) const {
    const Eigen::Matrix3d cross = covariance.topRightCorner<3, 3>();
    return covariance.topLeftCorner<3, 3>() + ahead * (cross + cross.transpose()) +
           ahead * ahead * covariance.bottomRightCorner<3, 3>();
  }
};

/// The k of `k sqrt(n^T P n)`, by which a distance along n to what is known with covariance P
/// counts for less.
inline constexpr double kConfidence = 3.0;

/// kConfidence sqrt(n^T P n), m.
inline double Uncertainty(const Eigen::Matrix3d& position_covariance,
                          const Eigen::Vector3d& normal) {
  return kConfidence * std::sqrt(std::max(normal.dot(position_covariance * normal), 0.0));
}

}  // namespace oca::geometry
