// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "oca/models/geometry/distance.h"
#include "oca/models/name.h"

namespace oca::robot {

class RobotModel;

/// The solids of one link, ready for distance queries, and a ball around all of them.
struct LinkCollider {
  struct Element {
    Eigen::Isometry3d X_LC;
    std::shared_ptr<const geometry::Collider> collider;
  };
  models::Name link;
  int number;  ///< of the link in its model
  std::vector<Element> elements;
  Eigen::Vector3d centre;  ///< of the ball, in the link's frame
  double radius;
};

/// Those links of a model that have solids, in the model's order.
/// throws ModelError for a solid that MakeCollider refuses
std::vector<LinkCollider> LinkCollidersOf(const RobotModel& model);

/// Least signed distance of the solids of a link at X_WL to those of another body, with the normal
/// from that body to the link. Its status is kBeyond if it exceeds `max_distance`. No heap.
geometry::SignedDistance DistanceToBody(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                                        const geometry::Collider& body,
                                        const Eigen::Isometry3d& X_WB, double max_distance);
geometry::SignedDistance DistanceToLink(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                                        const LinkCollider& other, const Eigen::Isometry3d& X_WO,
                                        double max_distance);

}  // namespace oca::robot
