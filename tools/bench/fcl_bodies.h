// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcl/fcl.h>

#include <memory>
#include <vector>

#include "oca/models/geometry/collider.h"
#include "oca/systems/sensing/link_colliders.h"
#include "oca/systems/signals/signals.h"

namespace oca::bench {

/// A shape for FCL; throws std::invalid_argument for what FCL or this bench does not know.
std::shared_ptr<fcl::CollisionGeometryd> ToFcl(const geometry::Shape& shape);

/// What BulletDistance does, written plainly with FCL: each link against each obstacle, left out if
/// `cull` is set and the bounding balls are farther apart than max_distance.
class FclScene {
 public:
  FclScene(const std::vector<systems::LinkCollider>& links, const systems::ObstacleSet& obstacles,
           double max_distance, bool cull);
  /// Distances and nearest points for links at X_WL, one pose a link of the model.
  const std::vector<systems::Proximity>& Calc(const std::vector<Eigen::Isometry3d>& X_WL);

 private:
  struct Body {
    std::unique_ptr<fcl::CollisionObjectd> object;
    models::Name name;
    int link;             // number in the model; -1 an obstacle
    Eigen::Isometry3d X;  // in the link or in the world
    Eigen::Vector3d centre;
    double radius;
  };
  std::vector<Body> links_;
  std::vector<Body> obstacles_;
  double max_distance_;
  bool cull_;
  std::vector<systems::Proximity> found_;
};

}  // namespace oca::bench
