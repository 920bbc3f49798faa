// SPDX-License-Identifier: BSD-3-Clause
// What the tests of BulletDistance look at: balls, the links of an arm, and the pairs that are
// near.
#pragma once

#include <string>
#include <vector>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems::distance_scene {

inline Eigen::Isometry3d At(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// A sphere at rest.
inline Obstacle Ball(const std::string& id, const Eigen::Vector3d& xyz, double radius = 0.1) {
  ShapeParams shape;
  shape.radius = radius;
  Obstacle obstacle;
  obstacle.body = MakeObstacleBody(id, shape, id);
  obstacle.X_WO.translation() = xyz;
  return obstacle;
}

/// Without velocities.
inline LinkPoses LinksAt(const robot::RobotModel& model, const Eigen::VectorXd& q) {
  LinkPoses links;
  NameLinks(model, links);
  links.poses = robot::LinkPoses(model, q);
  return links;
}

/// "link obstacle" of each.
inline std::vector<std::string> Pairs(const ProximitySet& set) {
  std::vector<std::string> pairs;
  for (const Proximity& p : set.proximities) {
    pairs.push_back(p.link.text() + " " + p.obstacle.text());
  }
  return pairs;
}

}  // namespace oca::systems::distance_scene
