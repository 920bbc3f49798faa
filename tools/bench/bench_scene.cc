// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/bench_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/sensing/link_colliders.h"

namespace oca::bench {
namespace {

using Eigen::Vector3d;
using systems::ShapeType;

constexpr double kReach = 1.5;      // m, of obstacles
constexpr double kClearance = 0.1;  // m, of obstacles from the path
const Vector3d kShoulder(0.0, 0.0, 1.16);

robot::LoadOptions OnPedestal() {
  robot::LoadOptions options;
  options.X_WB.translation().z() = 0.85;
  options.load_visuals = false;
  return options;
}

systems::ShapeParams RandomShape(std::mt19937_64& random) {
  std::uniform_real_distribution<double> size(0.05, 0.15);
  systems::ShapeParams shape;
  switch (std::uniform_int_distribution<int>(0, 3)(random)) {
    case 0:
      shape.type = ShapeType::kBox;
      shape.size = Vector3d(size(random), size(random), size(random));
      return shape;
    case 1:
      shape.type = ShapeType::kSphere;
      break;
    case 2:
      shape.type = ShapeType::kCylinder;
      shape.length = 2.0 * size(random);
      break;
    default:
      shape.type = ShapeType::kCapsule;
      shape.length = 2.0 * size(random);
  }
  shape.radius = 0.5 * size(random);
  return shape;
}

systems::Obstacle ToObstacle(const BenchObstacle& obstacle) {
  systems::Obstacle result;
  result.body = systems::MakeObstacleBody(obstacle.id, obstacle.shape, obstacle.id);
  result.X_WO.translation() = obstacle.position;
  return result;
}

bool Clear(const std::vector<systems::LinkCollider>& links,
           const std::vector<std::vector<Eigen::Isometry3d>>& path,
           const systems::Obstacle& obstacle) {
  for (const auto& X_WL : path) {
    for (const systems::LinkCollider& link : links) {
      const auto found = systems::DistanceToBody(link, X_WL[link.number], *obstacle.body->collider,
                                                 obstacle.X_WO, kClearance);
      if (found.status != geometry::DistanceStatus::kBeyond) return false;
    }
  }
  return true;
}

}  // namespace

std::shared_ptr<const robot::RobotModel> PrimitiveArm() {
  return std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf", OnPedestal()));
}

std::shared_ptr<const robot::RobotModel> OwnMeshArm() {
  return std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4_meshes.urdf", OnPedestal()));
}

std::shared_ptr<const robot::RobotModel> MeshArm() {
  const std::filesystem::path file = OCA_SOURCE_DIR "/../shared/data/robots/kuka_lwr/kuka.urdf";
  if (!std::filesystem::exists(file)) return nullptr;
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(file, OnPedestal()));
}

std::vector<Eigen::VectorXd> PathConfigurations(int count) {
  std::vector<Eigen::VectorXd> path;
  const double deg = M_PI / 180.0;
  for (int i = 0; i < count; ++i) {
    // To and fro in 20 s, so that the end meets the beginning.
    const double swing = 0.5 - 0.5 * std::cos(2.0 * M_PI * i / 2000.0);
    Eigen::VectorXd q(7);
    q << 2.75 * swing, 85 * deg, -30 * deg * swing, -35 * deg, 0.0, 30 * deg, 0.0;
    path.push_back(q);
  }
  return path;
}

std::vector<Eigen::VectorXd> RandomConfigurations(const robot::RobotModel& model, int count) {
  std::mt19937_64 random(11);
  std::vector<Eigen::VectorXd> configurations;
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXd q(model.num_positions());
    for (int j = 0; j < q.size(); ++j) {
      q[j] = std::uniform_real_distribution<double>(model.lower_limits()[j],
                                                    model.upper_limits()[j])(random);
    }
    configurations.push_back(q);
  }
  return configurations;
}

std::vector<BenchObstacle> MakeObstacles(const robot::RobotModel& arm, int count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto links = systems::MakeLinkColliders(arm);
  std::vector<std::vector<Eigen::Isometry3d>> path;
  const auto configurations = PathConfigurations(1000);
  for (std::size_t i = 0; i < configurations.size(); i += 20) {
    path.push_back(robot::LinkPoses(arm, configurations[i]));
  }
  std::vector<BenchObstacle> obstacles;
  while (static_cast<int>(obstacles.size()) < count) {
    const Vector3d direction =
        Vector3d(normal(random), normal(random), normal(random)).normalized();
    BenchObstacle obstacle{fmt::format("obstacle{}", obstacles.size()), RandomShape(random),
                           kShoulder + kReach * std::cbrt(unit(random)) * direction};
    if (Clear(links, path, ToObstacle(obstacle))) obstacles.push_back(std::move(obstacle));
  }
  return obstacles;
}

systems::ObstacleSet ToSet(const std::vector<BenchObstacle>& obstacles) {
  systems::ObstacleSet set;
  for (const BenchObstacle& obstacle : obstacles) set.obstacles.push_back(ToObstacle(obstacle));
  return set;
}

std::string ToYaml(const std::vector<BenchObstacle>& obstacles) {
  std::string text = "[";
  for (const BenchObstacle& obstacle : obstacles) {
    const systems::ShapeParams& shape = obstacle.shape;
    const Vector3d& p = obstacle.position;
    text += fmt::format("{}{{id: {}, shape: {{type: {}", text.size() > 1 ? ", " : "", obstacle.id,
                        EnumNames(shape.type)[static_cast<std::size_t>(shape.type)]);
    if (shape.radius) text += fmt::format(", radius: {}", *shape.radius);
    if (shape.length) text += fmt::format(", length: {}", *shape.length);
    if (shape.size)
      text += fmt::format(", size: [{}]", fmt::join(shape.size->begin(), shape.size->end(), ", "));
    text += fmt::format("}}, pose: {{xyz: [{}, {}, {}]}}}}", p.x(), p.y(), p.z());
  }
  return text + "]";
}

}  // namespace oca::bench
