// SPDX-License-Identifier: BSD-3-Clause
//
// What ticks cost when continuous state is integrated between them, and what witnesses add.

#include <benchmark/benchmark.h>

#include "oca/framework/simulation/simulator.h"
#include "tools/bench/engine_floors.h"
#include "tools/bench/tick_diagram.h"

namespace oca::bench {
namespace {

using Plant = TickDiagram::Plant;

constexpr double kIntegrated = 0.5099995;  // of row d at 10.1 s
/// Of row d14 there: critically damped at w = 20 rad/s it follows the ramp 2 / w late, and the hold
/// half a tick.
constexpr double kServoed = 0.01 * (10.1 - 0.1 - 0.0005);

void Integrate(benchmark::State& state, Plant plant, IntegratorKind kind, double expected) {
  const TickDiagram ticks({.plant = plant});
  Simulator simulator(*ticks.diagram, {.integrator = kind});
  RunTicks(state, ticks, simulator, expected, 1e-6);
}

template <std::size_t N>
void IntegrateFloor(benchmark::State& state, const FloorPlant<N>& plant) {
  const FloorRamp ramp;
  const FloorLimiter limiter;
  const FloorBlock* const blocks[] = {&ramp, &limiter};
  benchmark::DoNotOptimize(blocks);
  Array7 target{}, limited{};
  Values<N> x{};
  std::int64_t tick = 0;
  for (auto _ : state) {
    const double t = static_cast<double>(++tick) / 1000.0;
    blocks[0]->Calc(t, limited, target);
    blocks[1]->Calc(t, target, limited);
    FloorStep(plant, limited, 1e-3, x);
    benchmark::DoNotOptimize(x.data());
  }
}

void IntegratorFloor(benchmark::State& state) {
  const auto plant = std::make_unique<FloorIntegrator>();
  const FloorPlant<kWidth>* base = plant.get();
  benchmark::DoNotOptimize(base);
  IntegrateFloor(state, *base);
}

void ServoFloor(benchmark::State& state) {
  const auto plant = std::make_unique<FloorServo>();
  const FloorPlant<2 * kWidth>* base = plant.get();
  benchmark::DoNotOptimize(base);
  IntegrateFloor(state, *base);
}

/// An iteration is a crossing: a step past it, its location, the reset, and the restart.
void Crossing(benchmark::State& state, IntegratorKind kind) {
  constexpr int kCrossings = 1000;
  DiagramBuilder builder;
  const auto& shuttle = builder.Add<Shuttle>("shuttle");
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = kind, .max_step = 0.01, .fixed_step = 0.01});
  simulator.AdvanceTo(1.0);
  const Context warm = simulator.context();
  const AllocationCounter allocations(state);
  while (state.KeepRunningBatch(kCrossings)) {
    const std::int64_t before = simulator.statistics().crossings;
    simulator.context() = warm;
    simulator.AdvanceTo(1.0 + 0.01 * kCrossings);
    if (simulator.statistics().crossings - before != kCrossings) {
      state.SkipWithError("crossings were missed");
      break;
    }
  }
  benchmark::DoNotOptimize(shuttle.out.Eval(simulator.context())[0]);
}

constexpr auto kFixed = IntegratorKind::kFixedDp5;
constexpr auto kErk = IntegratorKind::kErkDp5;
constexpr auto kAdams = IntegratorKind::kCvodeAdams;
constexpr auto kBdf = IntegratorKind::kCvodeBdf;

BENCHMARK(IntegratorFloor)->Name("engine/d/floor");
BENCHMARK_CAPTURE(Integrate, d, Plant::kIntegrator, kFixed, kIntegrated)
    ->Name("engine/d/fixed_dp5");
BENCHMARK_CAPTURE(Integrate, d, Plant::kIntegrator, kErk, kIntegrated)->Name("engine/d/erk_dp5");
BENCHMARK(ServoFloor)->Name("engine/d14/floor");
BENCHMARK_CAPTURE(Integrate, d14, Plant::kServo, kFixed, kServoed)->Name("engine/d14/fixed_dp5");
BENCHMARK_CAPTURE(Integrate, d14, Plant::kServo, kErk, kServoed)->Name("engine/d14/erk_dp5");
BENCHMARK_CAPTURE(Integrate, d14, Plant::kServo, kAdams, kServoed)->Name("engine/d14/cvode_adams");
BENCHMARK_CAPTURE(Integrate, d14, Plant::kServo, kBdf, kServoed)->Name("engine/d14/cvode_bdf");
BENCHMARK_CAPTURE(Integrate, guarded, Plant::kGuarded, kFixed, kIntegrated)
    ->Name("engine/witness/fixed_dp5");
BENCHMARK_CAPTURE(Integrate, guarded, Plant::kGuarded, kErk, kIntegrated)
    ->Name("engine/witness/erk_dp5");
BENCHMARK_CAPTURE(Crossing, fixed, kFixed)->Name("engine/crossing/fixed_dp5");
BENCHMARK_CAPTURE(Crossing, erk, kErk)->Name("engine/crossing/erk_dp5");

}  // namespace
}  // namespace oca::bench
