// SPDX-License-Identifier: BSD-3-Clause
//
// Many obstacles, most of them far or all under one id. Rows geometry/far/N: the tick of seven mesh
// links among 10 near obstacles and N others 10 m away, one of which moves. geometry/cloud/N: the
// same links against one cloud of N points around the arm. geometry/cloud_build/N: what a new cloud
// takes, as a depth camera sends one 30 times a second.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "oca/models/geometry/point_cloud.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/systems/system_bench.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/bench_scene.h"

namespace oca::bench {
namespace {

using Eigen::Vector3d;

constexpr double kManyNear = 0.3;  // m
constexpr int kManyConfigurations = 1000;

/// Points on a sphere's surface 0.9 to 1.1 m around the shoulder: what stands around the arm.
std::vector<Vector3d> Surroundings(int count) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> distance(0.9, 1.1);
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const Vector3d direction(normal(random), normal(random), normal(random));
    points.push_back(Vector3d(0.0, 0.0, 1.16) + distance(random) * direction.normalized());
  }
  return points;
}

void TickAmong(benchmark::State& state, const systems::ObstacleSet& obstacles, int moving) {
  const auto arm = MeshArm() ? MeshArm() : PrimitiveArm();
  systems::ModelSet models;
  models.Add("arm", arm);
  std::vector<systems::LinkPoses> poses;
  for (const auto& q : PathConfigurations(kManyConfigurations)) {
    systems::NameLinks(*arm, poses.emplace_back());
    poses.back().poses = robot::LinkPoses(*arm, q);
  }
  const std::vector<systems::LinkCollider> colliders = systems::MakeLinkColliders(*arm);
  systems::ObstacleScene scene;
  systems::ObstacleSet set = obstacles;
  set.layout = 1;
  if (moving >= 0) set.moving = {moving};
  scene.Follow(set);
  systems::NearObstacles near;
  near.Clear(colliders.size(), set.obstacles.size());
  std::size_t i = 0, found = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    i = i + 1 == poses.size() ? 0 : i + 1;
    if (moving >= 0) {
      set.obstacles[static_cast<std::size_t>(moving)].X_WO.translation().x() += 1e-6;
      scene.Follow(set);
    }
    near.Clear(colliders.size(), set.obstacles.size());
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      const systems::LinkCollider& link = colliders[k];
      const Eigen::Isometry3d& X_WL = poses[i].poses[static_cast<std::size_t>(link.number)];
      near.Add(scene.balls(), X_WL * link.centre, link.radius + kManyNear);
      for (const int place : near.of(k)) {
        const systems::Obstacle& obstacle = set.obstacles[static_cast<std::size_t>(place)];
        const auto distance =
            systems::DistanceToBody(link, X_WL, *obstacle.body->collider, obstacle.X_WO, kManyNear);
        found += distance.status == geometry::DistanceStatus::kBeyond ? 0 : 1;
      }
    }
  }
  state.counters["found"] =
      benchmark::Counter(static_cast<double>(found), benchmark::Counter::kAvgIterations);
}

void Far(benchmark::State& state) {
  systems::ObstacleSet set = ToSet(MakeObstacles(*PrimitiveArm(), 10));
  const systems::Obstacle one = set.obstacles[0];
  const int count = static_cast<int>(state.range(0));
  for (int i = 0; i < count; ++i) {
    set.obstacles.push_back(one);
    const int column = i / 40 % 50, layer = i / 2000;
    set.obstacles.back().X_WO.translation() =
        Vector3d(10.0 + 0.3 * (i % 40), 0.3 * column, 0.3 * layer);
  }
  TickAmong(state, set, count > 0 ? 10 : -1);
}

void Cloud(benchmark::State& state) {
  const auto points = Surroundings(static_cast<int>(state.range(0)));
  systems::ObstacleSet set;
  set.obstacles.emplace_back();
  set.obstacles[0].body = std::make_shared<const systems::ObstacleBody>(systems::ObstacleBody{
      models::Name("cloud"), geometry::MakeCollider(geometry::MakeCloud(points, 0.01), "cloud"),
      ""});
  TickAmong(state, set, -1);
}

void CloudBuild(benchmark::State& state) {
  const auto points = Surroundings(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        geometry::MakeCollider(geometry::MakeCloud(points, 0.01), "cloud").get());
  }
  state.counters["points"] = benchmark::Counter(static_cast<double>(points.size()),
                                                benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(Far)->Name("geometry/far")->Arg(0)->Arg(1000)->Arg(100'000);
BENCHMARK(Cloud)->Name("geometry/cloud")->Arg(1000)->Arg(10'000)->Arg(100'000);
BENCHMARK(CloudBuild)->Name("geometry/cloud_build")->Arg(1000)->Arg(10'000)->Arg(100'000);

}  // namespace
}  // namespace oca::bench
