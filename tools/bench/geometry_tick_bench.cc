// SPDX-License-Identifier: BSD-3-Clause
//
// The distance work of one tick: seven mesh links against N obstacles. Rows
// geometry/tick/N/path|random/cull|all, each with its peer .../fcl; `cull` leaves out what is
// beyond 0.3 m, `all` measures every pair. Rows .../primitives are those of an arm of capsules.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "oca/models/robot/kinematics.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/systems/system_bench.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/bench_scene.h"
#include "tools/bench/fcl_bodies.h"

namespace oca::bench {
namespace {

constexpr double kTickNear = 0.3;  // m
constexpr double kAll = 100.0;     // m
constexpr int kTickConfigurations = 1000;

struct TickScene {
  TickScene(int obstacle_count, bool path, bool meshes)
      : arm(!meshes     ? PrimitiveArm()
            : MeshArm() ? MeshArm()
                        : OwnMeshArm()),
        obstacles(ToSet(MakeObstacles(*arm, obstacle_count))) {
    for (const auto& q : path ? PathConfigurations(kTickConfigurations)
                              : RandomConfigurations(*arm, kTickConfigurations)) {
      systems::LinkPoses links;
      systems::NameLinks(*arm, links);
      links.poses = robot::LinkPoses(*arm, q);
      poses.push_back(std::move(links));
    }
  }
  std::shared_ptr<const robot::RobotModel> arm;
  systems::ObstacleSet obstacles;
  std::vector<systems::LinkPoses> poses;
};

void Tick(benchmark::State& state, const TickScene& scene, double max_distance) {
  systems::ModelSet models;
  models.Add("arm", scene.arm);
  SystemBench<systems::BulletDistance> bench(
      systems::BulletDistance::Params{.model = "arm", .max_distance = max_distance}, models);
  bench->obstacles.Fix(bench.context(), scene.obstacles);
  bench->links.Fix(bench.context(), scene.poses[0]);
  std::size_t found = bench->proximities.Eval(bench.context()).proximities.size();
  std::size_t i = 0;
  std::size_t ticks = 0;
  found = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    i = i + 1 == scene.poses.size() ? 0 : i + 1;
    bench->links.Fix(bench.context(), scene.poses[i]);
    found += bench->proximities.Eval(bench.context()).proximities.size();
    ++ticks;
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(ticks);
}

void FclTick(benchmark::State& state, const TickScene& scene, double max_distance) {
  std::vector<systems::LinkCollider> links = systems::MakeLinkColliders(*scene.arm);
  std::erase_if(links, [&](const auto& link) { return scene.arm->body(link.number) < 0; });
  FclScene fcl(links, scene.obstacles, max_distance, max_distance == kTickNear);
  std::size_t i = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    i = i + 1 == scene.poses.size() ? 0 : i + 1;
    benchmark::DoNotOptimize(fcl.Calc(scene.poses[i].poses).data());
  }
}

void Register(int count, bool path, double max_distance, bool meshes) {
  const std::string name =
      fmt::format("geometry/tick/{}/{}/{}{}", count, path ? "path" : "random",
                  max_distance == kTickNear ? "cull" : "all", meshes ? "" : "/primitives");
  const auto add = [&](const std::string& row, auto run) {
    benchmark::RegisterBenchmark(row.c_str(), [=](benchmark::State& state) {
      run(state, TickScene(count, path, meshes), max_distance);
    });
  };
  add(name, Tick);
  add(name + "/fcl", FclTick);
}

void RegisterAll() {
  for (const bool path : {true, false}) {
    for (const int count : {1, 10, 100, 1000}) {
      for (const double max_distance : {kTickNear, kAll}) {
        for (const bool meshes : {true, false}) Register(count, path, max_distance, meshes);
      }
    }
  }
}

const bool kTicksRegistered = (RegisterAll(), true);

}  // namespace
}  // namespace oca::bench
