// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/link_colliders.h"

#include <algorithm>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {
namespace {

geometry::SignedDistance NothingNear() {
  geometry::SignedDistance nothing;
  nothing.status = geometry::DistanceStatus::kBeyond;
  return nothing;
}

void AddBall(LinkCollider& link) {
  Eigen::AlignedBox3d box;
  for (const auto& [X_LC, collider] : link.elements) {
    const Eigen::Vector3d centre = X_LC * collider->centre();
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(collider->bounding_radius());
    box.extend(centre - reach);
    box.extend(centre + reach);
  }
  link.centre = box.center();
  link.radius = 0.0;
  for (const auto& [X_LC, collider] : link.elements) {
    const double reach = (X_LC * collider->centre() - link.centre).norm();
    link.radius = std::max(link.radius, reach + collider->bounding_radius());
  }
}

bool BallsBeyond(const Eigen::Vector3d& centre_a, double radius_a, const Eigen::Vector3d& centre_b,
                 double radius_b, double max_distance) {
  const double reach = radius_a + radius_b + max_distance;
  return (centre_a - centre_b).squaredNorm() > reach * reach;
}

void KeepNearer(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                const geometry::Collider& body, const Eigen::Isometry3d& X_WB, double max_distance,
                geometry::SignedDistance& nearest) {
  for (const auto& [X_LC, collider] : link.elements) {
    // What is farther than the nearest so far need not be known exactly.
    const double limit = nearest.status == geometry::DistanceStatus::kBeyond
                             ? max_distance
                             : std::clamp(nearest.distance, 0.0, max_distance);
    const geometry::SignedDistance found =
        geometry::Distance(*collider, X_WL * X_LC, body, X_WB, limit);
    if (found.status == geometry::DistanceStatus::kBeyond || found.distance > max_distance)
      continue;
    if (nearest.status == geometry::DistanceStatus::kBeyond ||
        !(found.distance >= nearest.distance)) {
      nearest = found;
    }
  }
}

}  // namespace

std::vector<LinkCollider> LinkCollidersOf(const RobotModel& model) {
  std::vector<LinkCollider> colliders;
  for (int i = 0; i < model.num_links(); ++i) {
    const Link& link = model.links()[i];
    if (link.collisions.empty()) continue;
    LinkCollider collider{link.name, i, {}, Eigen::Vector3d::Zero(), 0.0};
    for (const CollisionElement& element : link.collisions) {
      collider.elements.push_back(
          {element.X_LC, geometry::MakeCollider(element.shape, element.source)});
    }
    AddBall(collider);
    colliders.push_back(std::move(collider));
  }
  return colliders;
}

geometry::SignedDistance DistanceToBody(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                                        const geometry::Collider& body,
                                        const Eigen::Isometry3d& X_WB, double max_distance) {
  geometry::SignedDistance nearest = NothingNear();
  if (BallsBeyond(X_WL * link.centre, link.radius, X_WB * body.centre(), body.bounding_radius(),
                  max_distance)) {
    return nearest;
  }
  KeepNearer(link, X_WL, body, X_WB, max_distance, nearest);
  return nearest;
}

geometry::SignedDistance DistanceToLink(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                                        const LinkCollider& other, const Eigen::Isometry3d& X_WO,
                                        double max_distance) {
  geometry::SignedDistance nearest = NothingNear();
  if (BallsBeyond(X_WL * link.centre, link.radius, X_WO * other.centre, other.radius,
                  max_distance)) {
    return nearest;
  }
  for (const auto& [X_OC, collider] : other.elements) {
    KeepNearer(link, X_WL, *collider, X_WO * X_OC, max_distance, nearest);
  }
  return nearest;
}

}  // namespace oca::robot
