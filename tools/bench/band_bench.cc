// SPDX-License-Identifier: BSD-3-Clause
//
// Rows planning/band (an elastic band relaxed from the request itself, past boxes, until a step
// gains less than 0.2 % of its cost) and its peer planning/band/ceres: the same cost, start and end
// by Ceres' Levenberg-Marquardt method with sparse normal equations, whose residuals and rows are
// those of tests/models/planning/band_in_ceres.cc. Counters, means over the scenes: `steps` that
// were tried, and `decades` of the cost gained.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "tests/models/planning/band_in_ceres.h"

namespace oca::bench {
namespace {

namespace band_scene = planning::test;

constexpr int kScenes = 20;
constexpr int kMostSteps = 60;
constexpr double kLeastGain = 2e-3;  // as in band_optimizer_steps.cc
constexpr int kSamples = 104;        // of a band, each a configuration to look at

/// relax(scene, curve, steps) returns the cost before and after.
template <class Relax>
void OverScenes(benchmark::State& state, const Relax& relax) {
  std::vector<band_scene::BandScene> scenes;
  for (int s = 0; s < kScenes; ++s) scenes.push_back(band_scene::MakeBandScene(s));
  double steps = 0.0, decades = 0.0;
  for (auto _ : state) {
    for (const auto& scene : scenes) {
      planning::BandCurve curve = band_scene::StraightBand();
      const auto [before, after] = relax(scene, curve, steps);
      decades += std::log10(before / after);
    }
  }
  const double count = kScenes * static_cast<double>(state.iterations());
  state.counters["steps"] = steps / count;
  state.counters["decades"] = decades / count;
}

void Band(benchmark::State& state) {
  OverScenes(state, [](const auto& scene, planning::BandCurve& curve, double& steps) {
    planning::BandOptimizer band(scene.model, {});
    band.Prepare(curve, scene.request, scene.bodies, true);
    const double before = band.Cost(curve);
    const long looked = band.evaluations();
    const double after = band.Relax(curve, kMostSteps);
    steps += static_cast<double>(band.evaluations() - looked) / kSamples - 1.0;
    return std::pair(before, after);
  });
}

void CeresBand(benchmark::State& state) {
  OverScenes(state, [](const auto& scene, planning::BandCurve& curve, double& steps) {
    const auto answer = band_scene::RelaxByCeres(scene, {}, kMostSteps, kLeastGain, curve);
    steps += answer.steps;
    return std::pair(answer.before, answer.after);
  });
}

BENCHMARK(Band)->Name("planning/band")->Unit(benchmark::kMillisecond);
BENCHMARK(CeresBand)->Name("planning/band/ceres")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace oca::bench
