// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/fcl_bodies.h"

#include <stdexcept>
#include <type_traits>

namespace oca::bench {
namespace {

std::shared_ptr<fcl::CollisionGeometryd> HullToFcl(const geometry::ConvexHull& hull) {
  auto vertices = std::make_shared<std::vector<Eigen::Vector3d>>(hull.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (const auto& t : hull.triangles) faces->insert(faces->end(), {3, t[0], t[1], t[2]});
  return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(hull.triangles.size()), faces);
}

}  // namespace

std::shared_ptr<fcl::CollisionGeometryd> ToFcl(const geometry::Shape& shape) {
  if (const auto* s = std::get_if<geometry::Sphere>(&shape)) {
    return std::make_shared<fcl::Sphered>(s->radius);
  }
  if (const auto* s = std::get_if<geometry::Box>(&shape))
    return std::make_shared<fcl::Boxd>(s->size);
  if (const auto* s = std::get_if<geometry::Cylinder>(&shape)) {
    return std::make_shared<fcl::Cylinderd>(s->radius, s->length);
  }
  if (const auto* s = std::get_if<geometry::Capsule>(&shape)) {
    return std::make_shared<fcl::Capsuled>(s->radius, s->length);
  }
  if (const auto* s = std::get_if<geometry::ConvexMesh>(&shape)) return HullToFcl(*s->hull);
  if (const auto* s = std::get_if<geometry::Cone>(&shape)) {
    return std::make_shared<fcl::Coned>(s->radius, s->length);
  }
  if (const auto* s = std::get_if<geometry::Ellipsoid>(&shape)) {
    return std::make_shared<fcl::Ellipsoidd>(s->radii);
  }
  throw std::invalid_argument("shape: got one that FCL has no peer of");
}

FclScene::FclScene(const std::vector<systems::LinkCollider>& links,
                   const systems::ObstacleSet& obstacles, double max_distance, bool cull)
    : max_distance_(max_distance), cull_(cull) {
  for (const systems::LinkCollider& link : links) {
    for (const auto& element : link.elements) {
      const geometry::Collider& collider = *element.collider;
      links_.push_back({std::make_unique<fcl::CollisionObjectd>(ToFcl(collider.shape())), link.link,
                        link.number, element.X_LC, element.X_LC * collider.centre(),
                        collider.bounding_radius()});
    }
  }
  for (const systems::Obstacle& obstacle : obstacles.obstacles) {
    const geometry::Collider& collider = *obstacle.body->collider;
    obstacles_.push_back(
        {std::make_unique<fcl::CollisionObjectd>(ToFcl(collider.shape()), obstacle.X_WO),
         obstacle.body->id, -1, obstacle.X_WO, obstacle.X_WO * collider.centre(),
         collider.bounding_radius()});
  }
  found_.reserve(links_.size() * obstacles_.size());
}

const std::vector<systems::Proximity>& FclScene::Calc(const std::vector<Eigen::Isometry3d>& X_WL) {
  found_.clear();
  fcl::DistanceRequestd request(true);
  request.gjk_solver_type = fcl::GST_LIBCCD;
  for (Body& link : links_) {
    const Eigen::Isometry3d& X = X_WL[static_cast<std::size_t>(link.link)];
    link.object->setTransform(X * link.X);
    const Eigen::Vector3d centre = X * link.centre;
    for (const Body& obstacle : obstacles_) {
      const double reach = link.radius + obstacle.radius + max_distance_;
      if (cull_ && (centre - obstacle.centre).squaredNorm() > reach * reach) continue;
      fcl::DistanceResultd result;
      const double distance =
          fcl::distance(link.object.get(), obstacle.object.get(), request, result);
      if (distance > max_distance_) continue;
      systems::Proximity proximity;
      proximity.link = link.name;
      proximity.obstacle = obstacle.name;
      proximity.distance = distance;
      proximity.point_on_link = result.nearest_points[0];
      proximity.point_on_obstacle = result.nearest_points[1];
      const Eigen::Vector3d gap = result.nearest_points[0] - result.nearest_points[1];
      if (gap.norm() > 0.0) proximity.normal = gap.normalized();
      found_.push_back(proximity);
    }
  }
  return found_;
}

}  // namespace oca::bench
