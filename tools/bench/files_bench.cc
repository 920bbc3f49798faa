// SPDX-License-Identifier: BSD-3-Clause
//
// From file to diagram: rows files/load and files/build make diagrams/static_test.yaml with the
// arm's housings as meshes, each time with another parameter, from the file and from a Blueprint
// that has read it; files/build/pose with the arm elsewhere.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::bench {
namespace {

constexpr const char* kFile = OCA_SOURCE_DIR "/diagrams/static_test.yaml";

/// The n-th variation of a parameter, from 0.2 on.
std::vector<files::Override> Variation(const char* path, int n) {
  return {{"parameters.arm_meshes", "true"}, {path, fmt::format("{}", 0.2 + 1e-6 * n)}};
}

void Load(benchmark::State& state) {
  int n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        loading::LoadDiagram(kFile, Variation("parameters.test_obstacle_height", n++)));
  }
}

void Build(benchmark::State& state, const char* path) {
  const loading::Blueprint blueprint(kFile);
  int n = 0;
  benchmark::DoNotOptimize(blueprint.Build(Variation(path, n++)));
  for (auto _ : state) benchmark::DoNotOptimize(blueprint.Build(Variation(path, n++)));
}

BENCHMARK(Load)->Name("files/load")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, parameter, "parameters.test_obstacle_height")
    ->Name("files/build")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, pose, "models.arm.base_pose.xyz.2")
    ->Name("files/build/pose")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace oca::bench
