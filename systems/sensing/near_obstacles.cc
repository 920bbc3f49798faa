// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/near_obstacles.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/json_fields.h"

namespace oca::systems {
namespace {

// Added to every reach, so that the rounding of a ball's place hides no pair; the distance itself
// decides who is beyond.
constexpr double kSlack = 1e-9;  // m

geometry::Ball BallOf(const Obstacle& obstacle) {
  const geometry::Collider& collider = *obstacle.body->collider;
  return {obstacle.X_WO * collider.centre(), collider.bounding_radius()};
}

}  // namespace

double SpeedBound(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular,
                  const Eigen::Isometry3d& X_WB, const geometry::Ball& ball) {
  const double turning = angular.norm();
  if (turning == 0.0) return linear.norm();  // of what has no end, too
  return (linear + angular.cross(X_WB.linear() * ball.centre)).norm() + turning * ball.radius;
}

double SpeedBound(const Obstacle& obstacle) {
  const geometry::Collider& collider = *obstacle.body->collider;
  return std::max(obstacle.body->fastest,
                  SpeedBound(obstacle.linear, obstacle.angular, obstacle.X_WO,
                             {collider.centre(), collider.bounding_radius()}));
}

void ObstacleScene::Follow(const ObstacleSet& set) {
  const auto& obstacles = set.obstacles;
  if (set.layout != 0 && set.layout == layout_ && obstacles.size() == kept_.size()) {
    fastest_ = 0.0;
    for (const int i : set.moving) {
      const Obstacle& obstacle = obstacles[static_cast<std::size_t>(i)];
      fastest_ = std::max(fastest_, SpeedBound(obstacle));
      Move(i, obstacle);
    }
    return;
  }
  layout_ = set.layout;
  if (!SameBodies(set)) Start(set);
  fastest_ = 0.0;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    fastest_ = std::max(fastest_, SpeedBound(obstacle));
    if (obstacle.X_WO.matrix() != kept_[i].X_WO.matrix()) Move(static_cast<int>(i), obstacle);
  }
}

bool ObstacleScene::SameBodies(const ObstacleSet& set) const {
  return std::equal(set.obstacles.begin(), set.obstacles.end(), kept_.begin(), kept_.end(),
                    [](const Obstacle& a, const Obstacle& b) { return a.body == b.body; });
}

void ObstacleScene::Start(const ObstacleSet& set) {
  const std::size_t most = std::max(capacity(), set.obstacles.capacity());
  kept_.reserve(most);
  start_.reserve(most);
  kept_ = set.obstacles;
  start_.clear();
  for (const Obstacle& obstacle : kept_) start_.push_back(BallOf(obstacle));
  balls_.Build(start_, most);
}

void ObstacleScene::Move(int index, const Obstacle& obstacle) {
  kept_[static_cast<std::size_t>(index)].X_WO = obstacle.X_WO;
  balls_.Move(index, BallOf(obstacle));
}

void NearObstacles::Clear(std::size_t links, std::size_t obstacles) {
  ends_.clear();
  ends_.reserve(links);
  obstacles_.clear();
  obstacles_.reserve(links * obstacles);
}

void NearObstacles::Add(const geometry::BallTree& balls, const Eigen::Vector3d& centre,
                        double reach) {
  balls.FindNear(centre, reach + kSlack, obstacles_);
  AddNone();
}

}  // namespace oca::systems

namespace oca {

using systems::Json;
using systems::JsonReader;
using systems::NearObstacles;
using systems::ObstacleScene;

Fault Signal<ObstacleScene>::Check(const ObstacleScene& /*value*/, Look /*look*/) { return {}; }

void Signal<ObstacleScene>::WriteJson(const ObstacleScene& value, std::string& out) {
  out += fmt::format(R"({{"obstacles":{}}})", value.balls().size());
}

ObstacleScene Signal<ObstacleScene>::ReadJson(std::string_view /*text*/) {
  throw ConfigError("scene: got one to read; expected none, it follows from the obstacles");
}

Fault Signal<NearObstacles>::Check(const NearObstacles& /*value*/, Look /*look*/) { return {}; }

void Signal<NearObstacles>::WriteJson(const NearObstacles& value, std::string& out) {
  Json list = Json::array();
  for (std::size_t link = 0; link < value.links(); ++link) list.push_back(value.of(link));
  out += list.dump();
}

NearObstacles Signal<NearObstacles>::ReadJson(std::string_view text) {
  const Json json = systems::ParseJson(text);
  NearObstacles near;
  JsonReader(json, "near").ForEach([&](const JsonReader& link) {
    link.ForEach([&](const JsonReader& item) {
      const double index = item.Number();
      if (!(index >= 0.0 && index < 1e9 && index == static_cast<double>(static_cast<int>(index)))) {
        item.Fail(fmt::format("{}", index), "a place in the list of obstacles");
      }
      near.obstacles_.push_back(static_cast<int>(index));
    });
    near.AddNone();
  });
  return near;
}

}  // namespace oca
